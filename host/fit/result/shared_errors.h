#pragma once

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// Errors of a matrix M that its entries share, after the inversion of a stack: an error of B, what
/// lies under the stack, moves whole rows and columns of M, and so does every number of the stack.
struct SharedErrors {
    /// dM = left dB right; (emission, common bands), (common bands, excitation).
    Eigen::MatrixXd left, right;
    Eigen::MatrixXd variance; ///< of the entries of B, (common bands, common bands)
    /// dM of one standard error of what else is uncertain, (emission, excitation).
    std::vector<Eigen::MatrixXd> directions;

    /// Returns the variance of every entry of M, (emission, excitation).
    Eigen::MatrixXd entry_variance() const;
    /// Returns a root of the covariance, root root^T, of quantities that are gain (quantities,
    /// entries of M in column-major order) times M.
    Eigen::MatrixXd root(const Eigen::MatrixXd& gain) const;
};

} // namespace reradiant
