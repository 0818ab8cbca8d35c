#pragma once

#include "reradiant/fit.h"

#include <nlohmann/json.hpp>

namespace reradiant {

/// How a fit went and what it found besides the matrix: what `fit --json` writes.
nlohmann::ordered_json fit_summary(const FitResult& result);

} // namespace reradiant
