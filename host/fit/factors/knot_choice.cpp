#include "host/fit/factors/knot_choice.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Normal equations of values at knots: tridiagonal, since only neighbours share bands.
struct Tridiagonal {
    std::vector<double> diagonal, beside, right;

    explicit Tridiagonal(std::size_t count) : diagonal(count), beside(count), right(count) {}

    /// right * solution, which is what the fit takes off the sum of squares (Thomas 1949).
    double explained() {
        const double least = 1e-12 * *std::max_element(diagonal.begin(), diagonal.end()) + 1e-300;
        double sum = 0.0;
        for (std::size_t j = 0; j < diagonal.size(); ++j) {
            if (j > 0) {
                const double share = beside[j - 1] / diagonal[j - 1];
                diagonal[j] -= share * beside[j - 1];
                right[j] -= share * right[j - 1];
            }
            diagonal[j] = std::max(diagonal[j], least);
            sum += right[j] * right[j] / diagonal[j];
        }
        return sum;
    }
};

/// One kind of curve, all terms of it, on its way to fewer knots.
class ThinnedCurve {
public:
    /// Both (bands, terms); curvature: of chi squared by every value.
    ThinnedCurve(Matrix values, Matrix curvature)
        : values_(std::move(values)), curvature_(std::move(curvature)),
          knots_(static_cast<std::size_t>(values_.rows())) {
        std::iota(knots_.begin(), knots_.end(), 0);
        find_cheapest();
    }

    const std::vector<int>& knots() const { return knots_; }
    double cheapest_loss() const { return loss_; }
    void take_cheapest() {
        cost_ += loss_;
        knots_.erase(knots_.begin() + static_cast<std::ptrdiff_t>(cheapest_));
        find_cheapest();
    }

private:
    void find_cheapest() {
        loss_ = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; knots_.size() > 2 && k < knots_.size(); ++k) {
            std::vector<int> fewer = knots_;
            fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
            const double loss = cost_of(fewer) - cost_;
            if (loss < loss_) {
                loss_ = loss;
                cheapest_ = k;
            }
        }
    }

    double cost_of(const std::vector<int>& knots) const {
        double cost = 0.0;
        for (Eigen::Index term = 0; term < values_.cols(); ++term)
            cost += curvature_.col(term).dot(values_.col(term).cwiseAbs2()) -
                    equations(knots, term).explained();
        return cost;
    }

    Tridiagonal equations(const std::vector<int>& knots, Eigen::Index term) const {
        Tridiagonal sums(knots.size());
        const auto add = [&](std::size_t knot, int band, double share) {
            const double weight = curvature_(band, term);
            sums.diagonal[knot] += weight * share * share;
            sums.right[knot] += weight * share * values_(band, term);
        };
        add(knots.size() - 1, knots.back(), 1.0);
        for (std::size_t j = 0; j + 1 < knots.size(); ++j)
            for (int band = knots[j]; band < knots[j + 1]; ++band) {
                const double share =
                    static_cast<double>(band - knots[j]) / (knots[j + 1] - knots[j]);
                add(j, band, 1.0 - share);
                add(j + 1, band, share);
                sums.beside[j] += curvature_(band, term) * share * (1.0 - share);
            }
        return sums;
    }

    Matrix values_, curvature_;
    std::vector<int> knots_;
    double cost_ = 0.0, loss_ = 0.0;
    std::size_t cheapest_ = 0;
};

} // namespace

std::size_t numbers_of_positions(const FitTarget& target) {
    constexpr Eigen::Index bits = 32;
    return static_cast<std::size_t>((target.value.rows() + target.value.cols() + bits - 1) / bits);
}

CurveKnots choose_knots(const FitTarget& target, const FactorCurves& curves, std::size_t count) {
    const Matrix squared = target.weight.cwiseAbs2();
    ThinnedCurve emission(curves.emission, squared * curves.excitation.cwiseAbs2());
    ThinnedCurve excitation(curves.excitation, squared.transpose() * curves.emission.cwiseAbs2());
    while (emission.knots().size() + excitation.knots().size() > std::max<std::size_t>(count, 4))
        if (emission.cheapest_loss() <= excitation.cheapest_loss())
            emission.take_cheapest();
        else
            excitation.take_cheapest();
    return {emission.knots(), excitation.knots()};
}

} // namespace reradiant
