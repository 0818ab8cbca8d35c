#pragma once

#include "host/fit/data/fit_target.h"
#include "host/fit/factors/smooth_basis.h"

#include <vector>

namespace reradiant {

/// One number for every band and term.
struct FactorCurves {
    Eigen::MatrixXd emission, excitation; ///< (emission bands, K), (excitation bands, K)
};

/// Hierarchical alternating least squares (Cichocki and Phan 2009) with weights: one factor column
/// at a time is set to its non-negative optimum. Robust from any start, slow near the end. Bands
/// that no used entry depends on become zero. Returns chi squared.
double descend_factors(const FitTarget& target, FactorCurves& curves, int sweeps);

/// The best `starts` initial guesses of a rank >= 1, best first, each after some descent: from the
/// singular vectors (Boutsidis and Gallopoulos 2008), from the best of the rank below (may be of
/// rank 0) plus one term, and random ones.
std::vector<FactorCurves> factor_starts(const FitTarget& target, int rank,
                                        const FactorCurves& smaller, int starts, unsigned seed,
                                        int threads);

/// Coefficients (functions, K) >= 0 whose curves come near to the given ones (bands, K).
Eigen::MatrixXd coefficients_near(const SmoothBasis& basis, const Eigen::MatrixXd& curves);

} // namespace reradiant
