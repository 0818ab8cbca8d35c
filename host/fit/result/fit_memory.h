#pragma once

#include "reradiant/fit.h"

#include <cstdint>

namespace reradiant {

/// Input Error, naming the data's file, when a fit would take more memory than the limit (0: 80 %
/// of the machine's).
void check_fit_memory(const BispectralData& data, const FitSettings& settings,
                      std::uint64_t limit_bytes);

} // namespace reradiant
