#pragma once

#include "reradiant/fit.h"

#include <nlohmann/json.hpp>

namespace reradiant {

/// Returns what `fit --json` writes: how a fit went, and what it found besides the matrix.
nlohmann::ordered_json fit_summary(const FitResult& result);

} // namespace reradiant
