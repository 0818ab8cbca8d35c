#pragma once

#include "host/fit/solver/solve_journal.h"
#include "reradiant/fit.h"

#include <nlohmann/json.hpp>

namespace reradiant {

/// Returns what `fit --json` writes: how a fit went, and what it found besides the matrix.
/// `failure` is null, or what failed: its stage (`minimisation` or `check` of what came out) and a
/// message.
nlohmann::ordered_json fit_summary(const FitResult& result);

/// Returns what `fit --json` writes where no result came out: the same `failure`, whose stage may
/// also be `stack` (its unknown numbers come before any minimisation), and how far the fit got.
nlohmann::ordered_json fit_failure_summary(FitModel model, const std::string& message,
                                           const SolveProgress& progress);

} // namespace reradiant
