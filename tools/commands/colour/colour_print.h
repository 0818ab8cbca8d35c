#pragma once

#include "tools/commands/colour/seen_colours.h"

namespace reradiant {

/// Prints all that a report says.
void print_colour(const ColourReport& report, const ColourOptions& options);

} // namespace reradiant
