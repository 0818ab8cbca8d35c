#include "host/fit/model_selection.h"

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

double misfit_of(double chi_squared, Eigen::Index data, Evidence evidence) {
    const double n = static_cast<double>(std::max<Eigen::Index>(1, data));
    return evidence == Evidence::KnownNoise ? chi_squared : n * std::log1p(chi_squared / n);
}

/// Of a positive definite matrix.
double log_determinant(const Matrix& matrix) {
    return 2.0 * Matrix(Eigen::LLT<Matrix>(matrix).matrixL()).diagonal().array().log().sum();
}

/// exp(x^2) erfc(x) for x >= 0; beyond 5 the first term of its series, right to 2 %.
double scaled_erfc(double x) {
    return x < 5.0 ? std::exp(x * x) * std::erfc(x) : std::numbers::inv_sqrtpi / x;
}

} // namespace

double information_criterion(double chi_squared, Eigen::Index parameters, Eigen::Index data,
                             Evidence evidence) {
    return misfit_of(chi_squared, data, evidence) +
           static_cast<double>(parameters) *
               std::log(static_cast<double>(std::max<Eigen::Index>(1, data)));
}

double laplace_criterion(const TermModel& model, const ModelFit& fit, const FitTarget& target,
                         Evidence evidence) {
    const Vector& at = fit.parameters;
    const Vector weights = target.weight.reshaped();
    // An entry depends on few parameters, as a bend does.
    const Sparse jacobian = weights.asDiagonal() * Sparse(model.entry_jacobian(at).sparseView());
    const Vector residual = (model.matrix(at) - target.value).reshaped().cwiseProduct(weights);
    const Sparse prior = model.prior_jacobian().sparseView();
    const Matrix prior_normal = Sparse(prior.transpose() * prior);
    const Matrix normal = Sparse(jacobian.transpose() * jacobian) + prior_normal;
    const Vector slope = jacobian.transpose() * residual + prior_normal * at;
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
    return misfit_of(fit.chi_squared, target.used_count(), evidence) + (prior * at).squaredNorm() +
           log_determinant(normal(free, free)) + at_zero - log_determinant(prior_normal);
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
