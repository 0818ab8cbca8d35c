#include "host/spectral/evidence/scatter_detection.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace reradiant {

namespace {

/// Standard deviations that a line must stand out by, and how much larger it must be than whatever
/// stands out beside it.
struct Limits {
    double deviations, over_largest;
};
constexpr Limits line_limits{5.0, 1.5};
/// The limits of the feet of a line that was found.
constexpr Limits feet_limits{2.5, 0.75};

/// Share of the excitations that must show a line, and their number. Beside the diagonal small
/// Stokes shifts look like one at an excitation or two.
struct Excitations {
    double share, number;
};
constexpr Excitations of_first_order{0.5, 3.0}, of_higher_orders{1.0 / 3.0, 2.0};
/// A line is at least this many times as long as its half width: a peak is not.
constexpr double least_elongation = 4.0;
/// No line has a larger half width: this is twice the reach of bandpasses of 20 nm.
constexpr double widest_nm = 60.0;
/// Bands beside the line, on each side, that it is compared with.
constexpr int controls_a_side = 8;
constexpr std::size_t fewest_controls = 4;
/// A line is at least this share of the largest entry elsewhere high: less does no harm.
constexpr double least_height = 1e-3;
/// 1.4826 times the median of |x| is the standard deviation of normal noise (Hampel 1974).
constexpr double deviations_of_median = 1.4826;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Contrasts of one excitation.
struct ColumnContrast {
    double on_line;
    std::vector<double> beside; ///< sizes

    /// Returns what the contrast on the line must exceed.
    double limit(const Limits& limits) const {
        return std::max(limits.deviations * deviations_of_median * median(beside),
                        limits.over_largest * *std::max_element(beside.begin(), beside.end()));
    }
};

double median_on_line(const std::vector<ColumnContrast>& columns) {
    std::vector<double> on_line;
    for (const ColumnContrast& column : columns)
        on_line.push_back(column.on_line);
    return on_line.empty() ? 0.0 : median(on_line);
}

/// Share of the limit that so many excitations reach; 0 when there are fewer.
double share_of_limit(const std::vector<ColumnContrast>& columns, double floor, double needed,
                      const Limits& limits) {
    std::vector<double> shares;
    for (const ColumnContrast& column : columns)
        shares.push_back(column.on_line / std::max(floor, column.limit(limits)));
    std::sort(shares.rbegin(), shares.rend());
    const auto last = static_cast<std::size_t>(std::ceil(needed));
    return shares.size() >= last ? shares[last - 1] : 0.0;
}

/// Looks for one line. It is built of rings, the bands of emission on both sides that lie equally
/// far from it: ring 0 is the band that the line lies in, or both that it lies between, or of the
/// first order the first beyond the spill.
class LineSearch {
public:
    LineSearch(const ReradiationMatrix& matrix, const ScatterSettings& settings, ScatterOrder order)
        : matrix_(matrix), contrast_(matrix, settings, order), order_(order),
          ratio_(scatter_ratio(order)), step_nm_(matrix.emission.step_nm),
          spill_nm_(settings.spill_nm) {}

    std::optional<FoundScatter> find() const {
        const std::optional<int> clearance = best_clearance();
        if (!clearance)
            return std::nullopt;
        int last = *clearance;
        while (last > 0 && !stands_out(last, *clearance, feet_limits))
            --last;
        while (half_width_nm(last + 1) <= widest_nm && stands_out(last + 1, last + 2, feet_limits))
            ++last;
        FoundScatter found{{order_, half_width_nm(last)}, 0, 0.0};
        found.height = median_on_line(contrasts(0, last));
        const Eigen::MatrixXd on = entries_on(found.line, matrix_.emission, matrix_.excitation);
        found.entries = static_cast<int>(
            ((on.array() > 0.0) && (matrix_.values.array() == matrix_.values.array())).count());
        return found;
    }

private:
    bool is_first() const { return order_ == ScatterOrder::First; }

    /// Returns the half width of a line whose last ring is this.
    double half_width_nm(int ring) const {
        return is_first() ? spill_nm_ + (ring + 1) * step_nm_ : (ring + 0.5) * step_nm_;
    }
    double outer_edge_nm(int ring) const { return half_width_nm(ring) + (0.5 - 1e-6) * step_nm_; }

    bool is_in(int ring, double distance_nm) const {
        return std::abs(distance_nm) < outer_edge_nm(ring) &&
               (ring == 0 || std::abs(distance_nm) >= outer_edge_nm(ring - 1));
    }

    /// The largest contrast of a ring at one excitation.
    std::optional<double> on_line(int ring, int i, double clearance_nm) const {
        std::optional<double> largest;
        for (int o = 0; o < matrix_.emission.count; ++o)
            if (is_in(ring, contrast_.distance_nm(o, i)))
                if (const auto contrast = contrast_(o, i, {0.0, clearance_nm}))
                    largest = std::max(largest.value_or(*contrast), *contrast);
        return largest;
    }

    /// Sizes of the contrasts beside the line at one excitation, as if it lay there: its nearest
    /// ring where the entry is.
    std::vector<double> beside(int i, double clearance_nm) const {
        std::vector<double> sizes;
        const double nearest = is_first() ? clearance_nm : 2.0 * clearance_nm;
        const double core = is_first() ? spill_nm_ + step_nm_ : 0.0;
        for (int o = 0; o < matrix_.emission.count; ++o) {
            const double distance = contrast_.distance_nm(o, i), size = std::abs(distance);
            if (size < nearest || size > nearest + controls_a_side * step_nm_)
                continue;
            const double shift = std::copysign(size - core, distance);
            if (const auto contrast = contrast_(o, i, {shift, clearance_nm}))
                sizes.push_back(std::abs(*contrast));
        }
        return sizes;
    }

    std::vector<ColumnContrast> contrasts(int ring, int clearance) const {
        const double clearance_nm = outer_edge_nm(clearance);
        std::vector<ColumnContrast> columns;
        for (int i = 0; i < matrix_.excitation.count; ++i) {
            const std::optional<double> largest = on_line(ring, i, clearance_nm);
            if (!largest)
                continue;
            ColumnContrast column{*largest, beside(i, clearance_nm)};
            if (column.beside.size() >= fewest_controls)
                columns.push_back(std::move(column));
        }
        return columns;
    }

    /// Height that is worth a mask, with this clearance.
    double floor(int clearance) const {
        double largest = 0.0;
        for (int i = 0; i < matrix_.excitation.count; ++i)
            for (int o = 0; o < matrix_.emission.count; ++o)
                if (contrast_.is_usable(o, i) &&
                    std::abs(contrast_.distance_nm(o, i)) > outer_edge_nm(clearance))
                    largest = std::max(largest, std::abs(matrix_.values(o, i)));
        return std::max(least_height * largest, std::numeric_limits<double>::min());
    }

    /// Returns a number over 1 when a ring stands out of what lies beyond another.
    double prominence(int ring, int clearance, const Limits& limits) const {
        const std::vector<ColumnContrast> columns = contrasts(ring, clearance);
        const Excitations least = is_first() ? of_first_order : of_higher_orders;
        const double length =
            least_elongation * half_width_nm(clearance) / (ratio_ * matrix_.excitation.step_nm);
        const double needed =
            std::max({least.number, length, least.share * static_cast<double>(columns.size())});
        return share_of_limit(columns, floor(clearance), needed, limits);
    }
    bool stands_out(int ring, int clearance, const Limits& limits) const {
        return prominence(ring, clearance, limits) > 1.0;
    }

    /// The ring beyond which the line's middle stands out most; empty: beyond none.
    std::optional<int> best_clearance() const {
        std::optional<int> best;
        double largest = 1.0;
        for (int ring = 0; half_width_nm(ring) <= widest_nm; ring += 1 + ring / 4)
            if (const double p = prominence(0, ring, line_limits); p > largest) {
                best = ring;
                largest = p;
            }
        return best;
    }

    const ReradiationMatrix& matrix_;
    ScatterContrast contrast_;
    ScatterOrder order_;
    double ratio_, step_nm_, spill_nm_;
};

} // namespace

std::vector<FoundScatter> find_scatter(const ReradiationMatrix& matrix,
                                       const ScatterSettings& settings) {
    std::vector<FoundScatter> found;
    for (const ScatterOrder order : scatter_orders) {
        if (order == ScatterOrder::Half && !settings.anti_stokes)
            continue;
        if (const auto line = LineSearch(matrix, settings, order).find())
            found.push_back(*line);
    }
    return found;
}

std::string scatter_text(const FoundScatter& found) {
    return fmt::format("{}-order scatter at emission = {} x excitation +- {} nm, about {:.2g} high "
                       "({} entries)",
                       scatter_order_name(found.line.order), scatter_ratio(found.line.order),
                       found.line.half_width_nm, found.height, found.entries);
}

} // namespace reradiant
