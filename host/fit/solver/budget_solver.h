#pragma once

#include "host/fit/data/fit_target.h"
#include "host/fit/models/fitted_model.h"
#include "host/fit/models/photon_penalty.h"

#include <chrono>

namespace reradiant {

/// One fitted model.
struct ModelFit {
    Eigen::VectorXd parameters;
    SolveTrace trace;
    double chi_squared = 0.0;     ///< of the data alone
    double diagonal_misfit = 0.0; ///< PhotonPenalty::misfit
};

/// Minimises a model whose photon sums must stay within the target's budget: rounds of
/// minimise_non_negative with the multipliers of `penalty` (which the model refers to) in between.
/// Not converged when some column still exceeds its budget by more than 1e-7.
ModelFit minimise_within_budget(const FittedModel& model, const FitTarget& target,
                                PhotonPenalty& penalty, const Eigen::VectorXd& start,
                                const SolverSettings& settings,
                                std::chrono::steady_clock::time_point begin);

} // namespace reradiant
