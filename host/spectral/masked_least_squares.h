#pragma once

#include <Eigen/Core>

namespace reradiant {

/// Non-negative least squares over the strictly lower triangle of a square matrix:
/// minimise cost = sum over o > i of (target(o, i) - sum_k emission(o, k) excitation(i, k))^2.
struct MaskedLeastSquares {
    Eigen::MatrixXd target; ///< square; only the strictly lower triangle is read

    int bands() const { return static_cast<int>(target.rows()); }
    double cost(const Eigen::MatrixXd& emission, const Eigen::MatrixXd& excitation) const;
    /// model - target below the diagonal, zero elsewhere.
    Eigen::MatrixXd residual(const Eigen::MatrixXd& emission,
                             const Eigen::MatrixXd& excitation) const;

    /// Hierarchical alternating least squares (Cichocki and Phan 2009), one factor column at a
    /// time: robust from any start, slow near the end.
    void descend(Eigen::MatrixXd& emission, Eigen::MatrixXd& excitation, int sweeps) const;
    /// Projected Levenberg-Marquardt (Kanzow, Yamashita, Fukushima 2004) on all factors at once;
    /// converges quadratically where the triangle is an exact product, which alternating methods
    /// do not. Stops when the cost stalls or after `most_steps`.
    void polish(Eigen::MatrixXd& emission, Eigen::MatrixXd& excitation, int most_steps) const;
};

} // namespace reradiant
