#pragma once

#include "reradiant/fit.h"

#include <filesystem>

namespace reradiant {

/// Writes a fit as one HTML page: numbers, why it stopped, data, model and residuals as heat maps,
/// curves with 95 % bands, cost against steps and seconds, what the data cannot tell. Atomic.
void write_fit_report(const std::filesystem::path& file, const BispectralData& data,
                      const FitResult& result);

} // namespace reradiant
