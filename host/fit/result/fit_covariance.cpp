#include "host/fit/result/fit_covariance.h"

#include "host/spectral/evidence/scatter_line.h"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

void append_direction(const Matrix& direction, MatrixCovariance& covariance) {
    Matrix& all = covariance.directions;
    all.conservativeResize(Eigen::NoChange, all.cols() + 1);
    all.rightCols(1) = direction.reshaped();
}

/// Mean of a normal deviate about `value` whose negative values count as zero, less `value`.
double bias_of_bound(double value, double sigma) {
    const double z = value / sigma;
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    return sigma * (density - 0.5 * z * std::erfc(z / std::numbers::sqrt2));
}

/// The part of a covariance's root that moves the entries: what one curve of a term gives the other
/// takes does not.
Matrix seen_root(const Matrix& root, const Matrix& directions) {
    constexpr double least_seen = 1e-10; // of the largest variance
    if (root.cols() == 0)
        return root;
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(directions.transpose() * directions);
    const Vector& variances = solver.eigenvalues(); // ascending
    const Eigen::Index seen = (variances.array() > least_seen * variances.maxCoeff()).count();
    return root * solver.eigenvectors().rightCols(seen);
}

/// Biases of all parameters: where noise would make one negative, it is zero instead, and the
/// others give way as far as they are correlated with it.
Vector biases_of_bounds(const TermModel& model, const Vector& parameters, const Matrix& root) {
    Vector share = Vector::Zero(parameters.size());
    for (Eigen::Index k = 0; k < parameters.size(); ++k)
        if (const double sigma = root.row(k).norm(); sigma > 0.0 && !model.may_be_negative(k))
            share(k) = bias_of_bound(parameters(k), sigma) / (sigma * sigma);
    return root * (root.transpose() * share);
}

} // namespace

MatrixCovariance covariance_of_model(const TermModel& model, const Vector& parameters,
                                     const Matrix& jacobian, const Covariance& covariance,
                                     const FitTarget& target) {
    const Eigen::Index bands = target.emission.count;
    Matrix directions = target.scale * (jacobian * covariance.root);
    for (Eigen::Index i = 0; i < covariance.diagonal_root.rows(); ++i)
        for (int o = 0; o < target.emission.count; ++o)
            if (on_diagonal(target.emission, o, target.excitation, static_cast<int>(i)))
                directions.row(o + i * bands) += covariance.diagonal_root.row(i);
    MatrixCovariance result{target.emission, target.excitation, directions,
                            Matrix::Zero(bands, target.excitation.count)};
    const Matrix root = seen_root(covariance.root, result.directions);
    append_direction(target.scale * (jacobian * biases_of_bounds(model, parameters, root)), result);
    return result;
}

void finish_covariance(const PreparedTarget& prepared, FitResult& result) {
    const FitTarget& target = prepared.target;
    const bool has_diagonal = prepared.errors && result.covariance;
    if (!result.covariance)
        result.covariance = {target.emission, target.excitation, Matrix(result.sigma.size(), 0),
                             Matrix::Zero(result.sigma.rows(), result.sigma.cols())};
    MatrixCovariance& covariance = *result.covariance;
    // Neighbours are rounded alike: the worst case is that all entries are.
    const Matrix rounding = prepared.shared_rounding.cwiseProduct(target.allowed);
    if (rounding.maxCoeff() > 0.0 && covariance.directions.cols() > 0)
        append_direction(rounding, covariance);
    for (int i = 0; i < target.excitation.count; ++i)
        if (const int o = diagonal_row(result.matrix, i); o >= 0 && !has_diagonal)
            covariance.independent(o, i) = prepared.diagonal_sigma(i);
    covariance.independent =
        result.sigma.array().isNaN().select(result.sigma, covariance.independent);
    covariance = in_fewer_directions(covariance);
    covariance.matrix = result.matrix.values;
}

} // namespace reradiant
