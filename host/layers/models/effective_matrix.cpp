#include "host/layers/models/effective_matrix.h"

#include "host/spectral/matrix/linear_systems.h"
#include "reradiant/error.h"

#include <Eigen/Eigenvalues>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

[[noreturn]] void throw_diverges(double radius) {
    throw_input_error({},
                      fmt::format("the feedback between substrate and layers has spectral radius "
                                  "{:.9g}, so the sum of interreflections diverges",
                                  radius),
                      "the product of internal reflectance and re-radiation matrix must stay "
                      "below 1");
}

/// Largest modulus of the eigenvalues, which a real Schur form has on its diagonal in blocks of 1 x
/// 1 and 2 x 2. Eigen's EigenSolver goes the same way, and takes twice as long to compile.
double spectral_radius(const Eigen::MatrixXd& matrix) {
    const Eigen::RealSchur<Eigen::MatrixXd> decomposition(matrix, false);
    if (decomposition.info() != Eigen::Success)
        return std::numeric_limits<double>::quiet_NaN();
    const Eigen::MatrixXd& schur = decomposition.matrixT();
    double radius = 0.0;
    for (Eigen::Index i = 0; i < schur.rows(); ++i) {
        double modulus = std::abs(schur(i, i));
        if (i + 1 < schur.rows() && schur(i + 1, i) != 0.0) {
            const double half = 0.5 * (schur(i, i) - schur(i + 1, i + 1));
            modulus =
                std::hypot(schur(i + 1, i + 1) + half,
                           std::sqrt(std::abs(half * half + schur(i + 1, i) * schur(i, i + 1))));
            ++i;
        }
        if (!std::isfinite(modulus))
            return modulus;
        radius = std::max(radius, modulus);
    }
    return radius;
}

/// Spectral radius, or a bound below 1 where a norm suffices.
double feedback_radius(const Eigen::MatrixXd& feedback) {
    const Eigen::MatrixXd size = feedback.cwiseAbs();
    const double bound = std::min(size.colwise().sum().maxCoeff(), size.rowwise().sum().maxCoeff());
    if (bound < 1.0)
        return bound;
    if (feedback.isUpperTriangular(0.0) || feedback.isLowerTriangular(0.0))
        return size.diagonal().maxCoeff();
    return spectral_radius(feedback);
}

} // namespace

Eigen::MatrixXd effective_matrix(const Eigen::MatrixXd& per_band, const Eigen::VectorXd& r) {
    const Eigen::Index n = per_band.rows();
    if (per_band.cols() != n || r.size() != n) {
        throw_input_error(
            {},
            fmt::format("a {} x {} matrix does not go with {} bands", n, per_band.cols(), r.size()),
            "emission and excitation must share one grid");
    }
    if (n == 0)
        return per_band;
    const Eigen::MatrixXd feedback = r.asDiagonal() * per_band;
    const double radius = feedback_radius(feedback);
    // eigenvalues come with rounding of a few parts in 1e16; 1e-12 from the pole is not a result
    if (!(radius < 1.0 - 1e-12))
        throw_diverges(radius);
    const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n) - feedback;
    return right_quotient(per_band, system);
}

Eigen::MatrixXd SemiseparableMatrix::dense() const {
    Eigen::MatrixXd full =
        (emission * excitation.transpose()).triangularView<Eigen::StrictlyLower>();
    full.diagonal() += diagonal;
    return full;
}

SemiseparableMatrix effective_semiseparable(const SemiseparableMatrix& matrix,
                                            const Eigen::VectorXd& r) {
    const Eigen::Index n = matrix.diagonal.size(), rank = matrix.emission.cols();
    if (r.size() != n || matrix.emission.rows() != n || matrix.excitation.rows() != n ||
        matrix.excitation.cols() != rank) {
        throw_input_error({}, "factors and internal reflectance have different numbers of bands",
                          "all of them must share one grid");
    }
    SemiseparableMatrix result{Eigen::VectorXd(n), Eigen::MatrixXd(n, rank),
                               Eigen::MatrixXd(n, rank)};
    // y = A (x + R y) with the running sum s_o = sum over i < o of x_i (x + r y)_i:
    // s_(o+1) = (I + r_o x_o e_o^T / (1 - r_o d_o)) s_o + x_o x / (1 - r_o d_o).
    // `product` is the product of these factors, `inverse` its inverse (Sherman-Morrison).
    Eigen::MatrixXd product = Eigen::MatrixXd::Identity(rank, rank);
    Eigen::MatrixXd inverse = product;
    for (Eigen::Index o = 0; o < n; ++o) {
        const double feedback = r(o) * matrix.diagonal(o);
        if (!(feedback < 1.0))
            throw_diverges(feedback);
        const double gain = 1.0 / (1.0 - feedback);
        const Eigen::RowVectorXd e = matrix.emission.row(o);
        const Eigen::VectorXd x = matrix.excitation.row(o).transpose();
        result.diagonal(o) = gain * matrix.diagonal(o);
        result.emission.row(o) = gain * e * product;
        const double echo = r(o) * gain;
        const double self = e.dot(x);
        product += echo * x * (e * product);
        inverse -= (echo / (1.0 + echo * self)) * (inverse * x) * e;
        result.excitation.row(o) = gain * (inverse * x).transpose();
    }
    return result;
}

} // namespace reradiant
