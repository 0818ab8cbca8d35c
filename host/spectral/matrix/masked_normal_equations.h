#pragma once

#include <Eigen/Core>

namespace reradiant {

/// One number for every entry of both factors.
struct FactorPair {
    Eigen::MatrixXd emission, excitation; ///< (bands, K) each
};

/// Solves (S J^T J S + diag(added)) v = -gradient for v, where J is the derivative of the strictly
/// lower triangle of emission * excitation^T by all entries of both factors and S a diagonal scale
/// (zero holds an entry still). Positive `added`. The emission's part of the matrix is one K x K
/// block a band; it is eliminated, which leaves a system in the excitation only.
FactorPair solve_normal_equations(const FactorPair& factors, const FactorPair& scale,
                                  const FactorPair& added, const FactorPair& gradient);

} // namespace reradiant
