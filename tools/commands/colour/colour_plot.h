#pragma once

#include "tools/commands/colour/seen_colours.h"

#include <string>
#include <vector>

namespace reradiant {

/// The radiance factors of one sample under every lamp as an SVG plot, those of the reference too
/// where there is one. They are the same for every observer.
std::string factors_plot(const SeenSample& sample, const ColourOptions& options);

/// The total radiance factors of several samples in one plot.
std::string totals_plot(const std::vector<SeenSample>& samples, const ColourOptions& options);

} // namespace reradiant
