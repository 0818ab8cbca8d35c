#pragma once

#include "tools/commands/colour/seen_colours.h"

#include <string>
#include <vector>

namespace reradiant {

/// The page of --report: swatches, colours, indices, a chromaticity diagram of each observer, what
/// must be known of lamps and samples, radiance factors. One HTML file that fetches nothing.
std::string colour_page(const std::vector<SeenSample>& samples, const ColourOptions& options);

} // namespace reradiant
