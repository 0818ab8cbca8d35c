#pragma once

#include "host/fit/models/model_selection.h"
#include "reradiant/fit.h"

#include <chrono>

namespace reradiant {

/// Fits `gaussians`: one after another is added where the data exceed the model most, and all are
/// adjusted together; as many as `settings` says, or as the evidence is for.
FittedCandidate fit_gaussians(const FitTarget& target, const FitSettings& settings,
                              Evidence evidence, std::chrono::steady_clock::time_point begin);

} // namespace reradiant
