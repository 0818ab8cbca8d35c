#pragma once

#include <Eigen/Core>

namespace reradiant {

/// Returns M (I - diag(r) M)^-1: a re-radiation matrix under a stack that returns the share r (per
/// emission band) of diffusely emitted flux to it, over all orders of interreflection. per_band:
/// (N, N), rows = emission, per-band form; r: (N), unit 1. It is solved densely in double
/// precision. Throws an input Error when the spectral radius of diag(r) M is 1 or more (the series
/// diverges), or when sizes disagree.
Eigen::MatrixXd effective_matrix(const Eigen::MatrixXd& per_band, const Eigen::VectorXd& r);

/// diag(diagonal) + [o > i] emission(o, :) . excitation(i, :): N numbers and two (N, K) factors.
struct SemiseparableMatrix {
    Eigen::VectorXd diagonal;
    Eigen::MatrixXd emission, excitation;

    Eigen::MatrixXd dense() const;
};

/// Returns M (I - diag(r) M)^-1, as `effective_matrix` does, in the masked factored form, which is
/// closed under this operation (same K; Vandebril, Van Barel, Mastronardi 2008, Matrix Computations
/// and Semiseparable Matrices, ch. 4). The new diagonal is d / (1 - r d); the new factors follow by
/// one forward recursion over the bands, at a cost of N K^2. The new excitation factors may be
/// negative; their product with the emission factors is not. Throws an input Error when some
/// r d >= 1.
SemiseparableMatrix effective_semiseparable(const SemiseparableMatrix& matrix,
                                            const Eigen::VectorXd& r);

} // namespace reradiant
