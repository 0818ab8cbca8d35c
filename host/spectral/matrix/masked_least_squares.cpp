#include "host/spectral/matrix/masked_least_squares.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double exact_relative_cost = 1e-18; ///< relative error 1e-9: nothing left to gain
constexpr int most_attempts = 10;             ///< raises of the damping within a step

/// Makes both columns of each term equally long, which conditions the joint problem best.
void balance_terms(FactorPair& factors) {
    for (Eigen::Index k = 0; k < factors.emission.cols(); ++k) {
        const double e = factors.emission.col(k).norm(), x = factors.excitation.col(k).norm();
        if (e > 0.0 && x > 0.0) {
            const double ratio = std::sqrt(x / e);
            factors.emission.col(k) *= ratio;
            factors.excitation.col(k) /= ratio;
        }
    }
}

FactorPair clipped(const FactorPair& factors) {
    return {factors.emission.cwiseMax(0.0), factors.excitation.cwiseMax(0.0)};
}

FactorPair moved(const FactorPair& factors, const FactorPair& scale, const FactorPair& step) {
    return {factors.emission + scale.emission.cwiseProduct(step.emission),
            factors.excitation + scale.excitation.cwiseProduct(step.excitation)};
}

/// Derivatives of half the cost by every entry.
FactorPair gradient_of(const FactorPair& factors, const Matrix& residual) {
    return {residual * factors.excitation, residual.transpose() * factors.emission};
}

/// Entry size at which a term alone would carry its row (emission) or column (excitation).
FactorPair natural_scale(const FactorPair& factors, const Vector& row_norm,
                         const Vector& column_norm) {
    const Eigen::Index n = factors.emission.rows(), rank = factors.emission.cols();
    FactorPair scale{Matrix::Zero(n, rank), Matrix::Zero(n, rank)};
    for (Eigen::Index k = 0; k < rank; ++k) {
        double below = 0.0, above = 0.0;
        for (Eigen::Index o = 0; o < n; ++o) {
            if (below > 0.0)
                scale.emission(o, k) = row_norm(o) / std::sqrt(below);
            below += factors.excitation(o, k) * factors.excitation(o, k);
        }
        for (Eigen::Index i = n - 1; i >= 0; --i) {
            if (above > 0.0)
                scale.excitation(i, k) = column_norm(i) / std::sqrt(above);
            above += factors.emission(i, k) * factors.emission(i, k);
        }
    }
    return scale;
}

/// Penalty on negative entries, in natural units: weight(o) * min(entry / scale, 0)^2.
struct Penalty {
    FactorPair scale;
    Vector row_weight, column_weight;

    static Matrix violation(const Matrix& factor, const Matrix& scale) {
        return (scale.array() > 0.0).select(factor.array().min(0.0) / scale.array(), 0.0);
    }
    double cost(const FactorPair& factors) const {
        return row_weight.dot(violation(factors.emission, scale.emission).rowwise().squaredNorm()) +
               column_weight.dot(
                   violation(factors.excitation, scale.excitation).rowwise().squaredNorm());
    }
    FactorPair gradient(const FactorPair& factors) const {
        return {row_weight.asDiagonal() * violation(factors.emission, scale.emission),
                column_weight.asDiagonal() * violation(factors.excitation, scale.excitation)};
    }
    FactorPair curvature(const FactorPair& factors) const {
        return {row_weight.asDiagonal() * Matrix((factors.emission.array() < 0.0).cast<double>()),
                column_weight.asDiagonal() *
                    Matrix((factors.excitation.array() < 0.0).cast<double>())};
    }
};

/// One Levenberg-Marquardt step: raises the damping until `cost_of` the step's end (passed through
/// `project`) falls below `cost_now`. False, and nothing moved, when it never does.
template <typename Added, typename Project, typename Cost>
bool damped_step(FactorPair& factors, const FactorPair& scale, const FactorPair& gradient,
                 double cost_now, double& damping, Added added, Project project, Cost cost_of) {
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        const FactorPair step = solve_normal_equations(factors, scale, added(damping), gradient);
        const FactorPair trial = project(moved(factors, scale, step));
        const bool improved = cost_of(trial) < cost_now;
        damping *= improved ? 0.25 : 4.0;
        if (improved) {
            factors = trial;
            return true;
        }
    }
    return false;
}

/// 1 for entries that may move, 0 for those held at zero by a gradient that points below it.
Matrix free_entries(const Matrix& factor, const Matrix& gradient) {
    return ((factor.array() > 0.0) || (gradient.array() < 0.0)).cast<double>();
}

} // namespace

Matrix MaskedLeastSquares::residual(const FactorPair& factors) const {
    const Matrix difference = factors.emission * factors.excitation.transpose() - target;
    return difference.triangularView<Eigen::StrictlyLower>();
}

void MaskedLeastSquares::descend(FactorPair& factors, int sweeps) const {
    const Eigen::Index n = target.rows();
    Matrix rest = -residual(factors);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (Eigen::Index k = 0; k < factors.emission.cols(); ++k) {
            auto e = factors.emission.col(k);
            auto x = factors.excitation.col(k);
            const Vector old_e = e, old_x = x;
            const Vector from_e = rest.triangularView<Eigen::StrictlyLower>() * x;
            double weight = 0.0;
            for (Eigen::Index o = 0; o < n; ++o) {
                e(o) = weight > 0.0 ? std::max(0.0, e(o) + from_e(o) / weight) : e(o);
                weight += x(o) * x(o);
            }
            rest.noalias() -= (e - old_e) * x.transpose();
            const Vector from_x = rest.transpose().triangularView<Eigen::StrictlyUpper>() * e;
            weight = 0.0;
            for (Eigen::Index i = n - 1; i >= 0; --i) {
                x(i) = weight > 0.0 ? std::max(0.0, x(i) + from_x(i) / weight) : x(i);
                weight += e(i) * e(i);
            }
            rest.noalias() -= e * (x - old_x).transpose();
        }
    }
}

void MaskedLeastSquares::approach(FactorPair& factors, int most_steps) const {
    constexpr double penalty_weight = 0.01, first_damping = 1e-3;
    constexpr int steps_per_scale = 10;
    const double whole = target.norm();
    const Vector row_norm = target.rowwise().norm();
    const Vector column_norm = target.colwise().norm().transpose();
    // Between the row's own weight and the whole's, so that faint rows are neither lost nor loud.
    const Vector row_weight = row_norm * whole, column_weight = column_norm * whole;
    const Eigen::RowVectorXd ones = Eigen::RowVectorXd::Ones(factors.emission.cols());
    const double least = 1e-30 * whole * whole;
    const FactorPair unit_damping{(row_weight.array() + least).matrix() * ones,
                                  (column_weight.array() + least).matrix() * ones};
    balance_terms(factors);
    Penalty penalty{{}, penalty_weight * row_weight, penalty_weight * column_weight};
    const auto penalised_cost = [&](const FactorPair& trial) {
        return cost(trial) + penalty.cost(trial);
    };
    double damping = first_damping;
    bool improved = true;
    for (int step = 0; step < most_steps && improved; ++step) {
        if (step % steps_per_scale == 0)
            penalty.scale = natural_scale(clipped(factors), row_norm, column_norm);
        const double cost_now = penalised_cost(factors);
        if (cost_now <= exact_relative_cost * whole * whole)
            break;
        const FactorPair slope = gradient_of(factors, residual(factors));
        const FactorPair gradient = moved(penalty.gradient(factors), penalty.scale, slope);
        const FactorPair curvature = penalty.curvature(factors);
        const auto added = [&](double amount) -> FactorPair {
            return {amount * unit_damping.emission + curvature.emission,
                    amount * unit_damping.excitation + curvature.excitation};
        };
        improved = damped_step(factors, penalty.scale, gradient, cost_now, damping, added,
                               std::identity(), penalised_cost);
    }
    factors = clipped(factors);
}

void MaskedLeastSquares::polish(FactorPair& factors, int most_steps) const {
    const double exact_cost = exact_relative_cost * target.squaredNorm();
    balance_terms(factors);
    double damping = 1e-3 * (factors.emission.squaredNorm() + factors.excitation.squaredNorm()) /
                     static_cast<double>(factors.emission.size());
    const auto added = [&](double amount) -> FactorPair {
        const Matrix all = Matrix::Constant(factors.emission.rows(), factors.emission.cols(),
                                            std::max(amount, 1e-300));
        return {all, all};
    };
    bool improved = true;
    for (int step = 0; step < most_steps && improved; ++step) {
        const Matrix rest = residual(factors);
        const double cost_now = rest.squaredNorm();
        if (cost_now <= exact_cost)
            return;
        const FactorPair slope = gradient_of(factors, rest);
        const FactorPair scale{free_entries(factors.emission, slope.emission),
                               free_entries(factors.excitation, slope.excitation)};
        const FactorPair gradient{scale.emission.cwiseProduct(slope.emission),
                                  scale.excitation.cwiseProduct(slope.excitation)};
        improved = damped_step(factors, scale, gradient, cost_now, damping, added, clipped,
                               [&](const FactorPair& trial) { return cost(trial); });
    }
}

} // namespace reradiant
