#pragma once

#include "host/fit/factors/factor_model.h"
#include "host/fit/models/model_selection.h"
#include "host/fit/solver/budget_solver.h"
#include "reradiant/fit.h"

#include <chrono>
#include <memory>

namespace reradiant {

/// Fits `factors` of the rank and the spacing of `settings`, or of those that the evidence is for.
FittedCandidate fit_factors(const FitTarget& target, const FitSettings& settings, Evidence evidence,
                            std::chrono::steady_clock::time_point begin);

} // namespace reradiant
