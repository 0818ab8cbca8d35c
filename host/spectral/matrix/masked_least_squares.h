#pragma once

#include "host/spectral/matrix/masked_normal_equations.h"

#include <Eigen/Core>

namespace reradiant {

/// Non-negative least squares over the strictly lower triangle of a square matrix:
/// minimise cost = sum over o > i of (target(o, i) - sum_k emission(o, k) excitation(i, k))^2.
struct MaskedLeastSquares {
    Eigen::MatrixXd target; ///< square, zero on and above the diagonal

    /// Model - target below the diagonal, zero elsewhere.
    Eigen::MatrixXd residual(const FactorPair& factors) const;
    double cost(const FactorPair& factors) const { return residual(factors).squaredNorm(); }

    /// Hierarchical alternating least squares (Cichocki and Phan 2009), one factor column at a
    /// time: robust from any start and indifferent to scale, slow near the end.
    void descend(FactorPair& factors, int sweeps) const;

    /// Levenberg-Marquardt on all entries at once, where being negative costs a penalty. An exact
    /// non-negative product has no penalty, so it is reached at quadratic speed and without the
    /// zigzag of active sets. Entries are measured in units of what their own row or column of
    /// the target asks for, since the factors of one fluorophore span many orders of magnitude
    /// where its bands overlap. Ends with what is left negative set to zero.
    void approach(FactorPair& factors, int most_steps) const;

    /// Projected Levenberg-Marquardt (Kanzow, Yamashita, Fukushima 2004): never leaves the
    /// non-negative entries and never raises the cost.
    void polish(FactorPair& factors, int most_steps) const;
};

} // namespace reradiant
