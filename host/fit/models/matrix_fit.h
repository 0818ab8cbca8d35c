#pragma once

#include "host/fit/result/quantum_yield.h"
#include "host/fit/solver/budget_solver.h"
#include "reradiant/fit.h"

#include <chrono>
#include <cstddef>

namespace reradiant {

/// A fitted `matrix` and the width of its posterior. In units of the target's scale, but for
/// `emitted`.
struct MatrixFit {
    ModelFit fit;
    Eigen::MatrixXd value, sigma;
    EmittedPhotons emitted;
    std::size_t stored_numbers = 0;
    double effective_numbers = 0.0; ///< trace of the smoother: what the data determine
};

/// Fits `matrix`. The smoothness in both directions is the one of most evidence when entries might
/// be negative (a Gaussian posterior, MacKay 1992); then Ceres finds the non-negative mode.
MatrixFit fit_matrix(const FitTarget& target, const FitSettings& settings, bool noise_is_estimated,
                     std::chrono::steady_clock::time_point begin);

} // namespace reradiant
