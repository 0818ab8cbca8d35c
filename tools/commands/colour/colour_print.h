#pragma once

#include "host/spectral/colour/colour_report.h"
#include "tools/commands/colour/colour_options.h"

#include <string>

namespace reradiant {

/// Returns the key of a report: LAMP, or LAMP/OBSERVER where there are several observers.
std::string key_of(const ColourReport& report, const ColourOptions& options);

/// Prints all that a report says.
void print_colour(const ColourReport& report, const ColourOptions& options);

} // namespace reradiant
