#include "host/spectral/covariance/colour_intervals.h"

#include "host/spectral/covariance/colour_gradient.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace reradiant {

namespace {

using Json = nlohmann::ordered_json;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double normal_95 = 1.959963984540054;
constexpr double tail = 0.025; ///< on either side of 95 %

/// A part of what is said about a colour: a name and its numbers.
struct Quantity {
    std::string name;
    std::vector<double> numbers;
};

/// A colour's quantities as functions of X, Y, Z and, where there is one, R457.
class Quantities {
public:
    Quantities(const IndexedColour& colour, std::string lamp, Observer observer)
        : colour_(colour), lamp_(std::move(lamp)), observer_(observer) {}

    Vector at_colour() const {
        Vector sums(colour_.r457 ? 4 : 3);
        for (Eigen::Index c = 0; c < 3; ++c)
            sums[c] = colour_.colour.xyz[static_cast<std::size_t>(c)];
        if (colour_.r457)
            sums[3] = *colour_.r457;
        return sums;
    }

    std::vector<Quantity> operator()(const Vector& sums) const {
        const Xyz xyz{sums[0], sums[1], sums[2]}, white = colour_.colour.white;
        const auto lab = xyz_to_lab(xyz, white);
        const auto lch = lab_to_lch(lab);
        const double all = xyz[0] + xyz[1] + xyz[2];
        std::vector<Quantity> list = {{"XYZ", {xyz[0], xyz[1], xyz[2]}},
                                      {"xy", {xyz[0] / all, xyz[1] / all}},
                                      {"Lab", {lab[0], lab[1], lab[2]}},
                                      {"LCh", {lch[0], lch[1], near_colour(lch[2])}}};
        if (colour_.whiteness) {
            const Whiteness whiteness = cie_whiteness(xyz, white, observer_);
            list.push_back({"whiteness_cie", {whiteness.whiteness}});
            list.push_back({"tint_cie", {whiteness.tint}});
        }
        if (colour_.r457)
            list.push_back({"r457", {sums[3]}});
        if (const auto e313 = astm_e313(xyz, lamp_, observer_)) {
            list.push_back({"whiteness_e313", {e313->whiteness}});
            list.push_back({"yellowness_e313", {e313->yellowness}});
        }
        return list;
    }

private:
    /// The hue within half a turn of the colour's own.
    double near_colour(double hue) const {
        return colour_.lch[2] + std::remainder(hue - colour_.lch[2], 360.0);
    }

    const IndexedColour& colour_;
    std::string lamp_;
    Observer observer_;
};

/// All numbers of the quantities in one row.
Vector flat(const std::vector<Quantity>& quantities) {
    std::vector<double> numbers;
    for (const Quantity& quantity : quantities)
        numbers.insert(numbers.end(), quantity.numbers.begin(), quantity.numbers.end());
    return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

std::vector<QuantityInterval> intervals_of(const std::vector<Quantity>& quantities,
                                           const Vector& error, const Vector& low,
                                           const Vector& high) {
    std::vector<QuantityInterval> list;
    Eigen::Index at = 0;
    for (const Quantity& quantity : quantities) {
        const auto count = static_cast<Eigen::Index>(quantity.numbers.size());
        const auto part = [&](const Vector& of) {
            return std::vector<double>(of.data() + at, of.data() + at + count);
        };
        list.push_back({quantity.name, part(error), part(low), part(high)});
        at += count;
    }
    return list;
}

/// What one standard error of every independent error adds to the sums, (errors, sums).
Matrix effects_on_sums(const Matrix& gradient, const MatrixCovariance& covariance) {
    const Vector own = covariance.independent.reshaped();
    std::vector<Eigen::Index> uncertain;
    for (Eigen::Index k = 0; k < own.size(); ++k)
        if (own[k] > 0.0)
            uncertain.push_back(k);
    const auto count = static_cast<Eigen::Index>(uncertain.size());
    Matrix effects(covariance.directions.cols() + count, gradient.cols());
    effects.topRows(covariance.directions.cols()) = covariance.directions.transpose() * gradient;
    effects.bottomRows(count) = own(uncertain).asDiagonal() * gradient(uncertain, Eigen::all);
    return effects;
}

std::vector<QuantityInterval> linearised(const Quantities& quantities, const Matrix& effects) {
    constexpr double step = 0.01; // standard errors
    const Vector at = quantities.at_colour();
    const std::vector<Quantity> here = quantities(at);
    const Vector numbers = flat(here);
    Matrix slopes = Matrix::Zero(numbers.size(), at.size());
    for (Eigen::Index c = 0; c < at.size(); ++c) {
        const double length = step * effects.col(c).norm();
        if (!(length > 0.0))
            continue;
        const Vector move = length * Vector::Unit(at.size(), c);
        slopes.col(c) =
            (flat(quantities(at + move)) - flat(quantities(at - move))) / (2.0 * length);
    }
    const Vector error = (slopes * effects.transpose()).rowwise().norm();
    return intervals_of(here, error, numbers - normal_95 * error, numbers + normal_95 * error);
}

/// Value that a share of a sorted list is below; linear between its entries.
double quantile(const std::vector<double>& sorted, double share) {
    const double position = share * static_cast<double>(sorted.size() - 1);
    const auto left = static_cast<std::size_t>(position);
    const auto right = std::min(left + 1, sorted.size() - 1);
    return sorted[left] + (position - static_cast<double>(left)) * (sorted[right] - sorted[left]);
}

/// Sums of drawn matrices, (draws, sums): those of the matrix and what its errors add.
Matrix drawn_sums(const Vector& at, const Matrix& effects, unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Matrix sums = at.transpose().replicate(drawn_matrices, 1);
    Vector errors(effects.rows());
    for (Eigen::Index draw = 0; draw < sums.rows(); ++draw) {
        for (double& error : errors)
            error = normal(random);
        sums.row(draw) += errors.transpose() * effects;
    }
    return sums;
}

std::vector<QuantityInterval> drawn(const Quantities& quantities, const Matrix& sums) {
    const std::vector<Quantity> here = quantities(quantities.at_colour());
    Matrix numbers(sums.rows(), flat(here).size());
    for (Eigen::Index draw = 0; draw < sums.rows(); ++draw)
        numbers.row(draw) = flat(quantities(sums.row(draw).transpose())).transpose();
    Vector error(numbers.cols()), low = error, high = error;
    for (Eigen::Index c = 0; c < numbers.cols(); ++c) {
        std::vector<double> sorted(numbers.col(c).begin(), numbers.col(c).end());
        std::sort(sorted.begin(), sorted.end());
        const double mean = numbers.col(c).mean();
        error[c] = std::sqrt((numbers.col(c).array() - mean).square().sum() /
                             static_cast<double>(sorted.size() - 1));
        low[c] = quantile(sorted, tail);
        high[c] = quantile(sorted, 1.0 - tail);
    }
    return intervals_of(here, error, low, high);
}

void warn_of_unknown(const Matrix& gradient, const MatrixCovariance& covariance,
                     std::vector<std::string>& warnings) {
    const Vector own = covariance.independent.reshaped();
    const Eigen::Index unknown =
        (own.array().isNaN() && gradient.cwiseAbs().rowwise().sum().array() > 0.0).count();
    if (unknown > 0)
        warnings.push_back(fmt::format(
            "the errors of {} entries that this colour depends on are not known and count as none: "
            "the intervals are too narrow",
            unknown));
}

Json quantities_json(const std::vector<QuantityInterval>& intervals) {
    Json json = Json::object();
    const auto shaped = [](const std::vector<double>& numbers) {
        return numbers.size() == 1 ? Json(numbers[0]) : Json(numbers);
    };
    for (const QuantityInterval& interval : intervals)
        json[interval.name] = {{"standard_error", shaped(interval.standard_error)},
                               {"low", shaped(interval.low)},
                               {"high", shaped(interval.high)}};
    return json;
}

} // namespace

void set_intervals(ColourReport& report, const ReradiationMatrix& matrix,
                   const MatrixCovariance& covariance, const Lamp& lamp, ColourSum sum,
                   unsigned seed) {
    require_covariance_of(matrix, covariance);
    ColourIntervals intervals;
    ColourConditions conditions{.observer = report.observer, .weighted_by = lamp.weighted_by};
    const auto fill = [&](const IndexedColour& colour, std::vector<QuantityInterval>& by_slopes,
                          std::vector<QuantityInterval>& by_draws) {
        const Matrix gradient =
            colour_gradient(matrix, lamp.light, sum, colour.colour.at_nanometres, conditions,
                            colour.r457.has_value());
        const Matrix effects = effects_on_sums(gradient, covariance);
        const Quantities quantities(colour, lamp.name, report.observer);
        by_slopes = linearised(quantities, effects);
        by_draws = drawn(quantities, drawn_sums(quantities.at_colour(), effects, seed));
        return gradient;
    };
    warn_of_unknown(fill(report, intervals.linearised, intervals.drawn), covariance,
                    report.warnings);
    conditions.excites_from_nm = uv_excluded_from_nm;
    fill(report.uv_excluded, intervals.uv_excluded_linearised, intervals.uv_excluded_drawn);
    report.intervals = std::move(intervals);
}

Json intervals_json(const ColourIntervals& intervals) {
    Json linearised = quantities_json(intervals.linearised);
    Json drawn = quantities_json(intervals.drawn);
    linearised["uv_excluded"] = quantities_json(intervals.uv_excluded_linearised);
    drawn["uv_excluded"] = quantities_json(intervals.uv_excluded_drawn);
    return {
        {"level", 0.95}, {"linearised", linearised}, {"drawn", drawn}, {"draws", drawn_matrices}};
}

} // namespace reradiant
