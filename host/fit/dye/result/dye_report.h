#pragma once

#include "host/fit/dye/dye_fit.h"

#include <filesystem>

namespace reradiant {

/// Writes an HTML page of fitted dyes: absorption and emission with 95 % bands, yields with and
/// without what is re-absorbed, data with their masks, residuals by excitation. Atomic.
void write_dye_report(const std::filesystem::path& file, const DyeFitResult& result);

} // namespace reradiant
