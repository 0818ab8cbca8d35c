#include "host/fit/models/model_selection.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Sparse = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// -2 log likelihood up to a constant, and its derivative by chi squared.
struct Misfit {
    double value, slope;

    Misfit(double chi_squared, Eigen::Index data, Evidence evidence)
        : value(chi_squared), slope(1.0) {
        if (evidence == Evidence::KnownNoise)
            return;
        const double n = static_cast<double>(std::max<Eigen::Index>(1, data));
        value = 2.0 * n * std::log1p(chi_squared / n);
        slope = 2.0 / (1.0 + chi_squared / n);
    }
};

/// An entry depends on few parameters, as a bend does.
Sparse weighted_jacobian(const TermModel& model, const Vector& at, const FitTarget& target) {
    const Vector weights = target.weight.reshaped();
    return weights.asDiagonal() * Sparse(model.entry_jacobian(at).sparseView());
}

/// Returns the logarithm of the determinant of a positive definite matrix.
double log_determinant(const Matrix& matrix) {
    return 2.0 * Matrix(Eigen::LLT<Matrix>(matrix).matrixL()).diagonal().array().log().sum();
}

/// exp(x^2) erfc(x) for x >= 0; beyond 5 the first term of its series, right to 2 %.
double scaled_erfc(double x) {
    return x < 5.0 ? std::exp(x * x) * std::erfc(x) : std::numbers::inv_sqrtpi / x;
}

/// Numbers that the data determine rather than the prior: trace of (J' W J + P)^-1 J' W J.
double effective_numbers(const TermModel& model, const ModelFit& fit, const FitTarget& target) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index k = 0; k < fit.parameters.size(); ++k)
        if (fit.parameters(k) > 0.0 || model.may_be_negative(k))
            free.push_back(k);
    const Sparse prior = model.prior_jacobian().sparseView();
    if (prior.rows() == 0)
        return static_cast<double>(free.size());
    const Sparse jacobian = weighted_jacobian(model, fit.parameters, target);
    const Matrix data = Matrix(Sparse(jacobian.transpose() * jacobian))(free, free);
    const Matrix whole = data + Matrix(Sparse(prior.transpose() * prior))(free, free);
    return Eigen::LLT<Matrix>(whole).solve(data).trace();
}

} // namespace

double information_criterion(double chi_squared, Eigen::Index parameters, Eigen::Index data,
                             Evidence evidence) {
    return Misfit(chi_squared, data, evidence).value +
           static_cast<double>(parameters) *
               std::log(static_cast<double>(std::max<Eigen::Index>(1, data)));
}

double laplace_criterion(const TermModel& model, const ModelFit& fit, const FitTarget& target,
                         Evidence evidence) {
    const Vector& at = fit.parameters;
    const Misfit misfit(fit.chi_squared + fit.diagonal_misfit, target.used_count(), evidence);
    const Sparse jacobian = weighted_jacobian(model, at, target);
    const Vector residual =
        (model.matrix(at) - target.value).cwiseProduct(target.weight).reshaped();
    const Sparse prior = model.prior_jacobian().sparseView();
    const Matrix prior_normal = Sparse(prior.transpose() * prior);
    const Matrix normal = misfit.slope * Sparse(jacobian.transpose() * jacobian) + prior_normal;
    const Vector slope = misfit.slope * (jacobian.transpose() * residual) + prior_normal * at;
    std::vector<Eigen::Index> free;
    double at_zero = 0.0;
    for (Eigen::Index k = 0; k < at.size(); ++k) {
        if (at(k) > 0.0) {
            free.push_back(k);
            continue;
        }
        const double h = normal(k, k);
        const double share = 0.5 * scaled_erfc(std::max(0.0, slope(k)) / std::sqrt(2.0 * h));
        at_zero += std::log(h) - 2.0 * std::log(share);
    }
    return misfit.value + (prior * at).squaredNorm() + log_determinant(normal(free, free)) +
           at_zero - log_determinant(prior_normal);
}

double degrees_of_freedom(const FittedCandidate& candidate, const FitTarget& target) {
    const double data = static_cast<double>(target.used_count());
    return std::max(1.0, candidate.model
                             ? data - effective_numbers(*candidate.model, candidate.fit, target)
                             : data);
}

bool residuals_are_noise(double chi_squared, double data, double freedom) {
    // The standard deviation of a reduced chi squared of noise is sqrt(2 / freedom).
    constexpr double deviations = 5.0;
    const double limit =
        std::max(largest_reduced_chi_squared, 1.0 + deviations * std::sqrt(2.0 / freedom));
    return chi_squared <= std::max(data, limit * freedom);
}

bool residuals_are_noise(const FittedCandidate& candidate, const FitTarget& target) {
    constexpr double margin = 0.9;
    return residuals_are_noise(candidate.fit.chi_squared / margin,
                               static_cast<double>(target.used_count()),
                               degrees_of_freedom(candidate, target));
}

FittedCandidate dark_candidate(const FitTarget& target, Evidence evidence) {
    FittedCandidate dark;
    dark.fit.chi_squared = target.value.cwiseProduct(target.weight).squaredNorm();
    dark.fit.trace.converged = true;
    dark.fit.trace.stop_reason = "there is nothing to fit";
    dark.criterion = information_criterion(dark.fit.chi_squared, 0, target.used_count(), evidence);
    return dark;
}

} // namespace reradiant
