#pragma once

#include "host/fit/dye/dye_fit.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace reradiant {

/// What `fit --dye --json` writes: the keys of every fit (fit_summary.h) where they have a meaning,
/// then `dyes`, `bands_nm`, `evidence` and the rest.
nlohmann::ordered_json dye_fit_summary(const DyeFitResult& result);

/// The dyes and what else was found, a sentence each.
std::vector<std::string> dye_sentences(const DyeFitResult& result);

} // namespace reradiant
