#pragma once

#include "tools/commands/colour/seen_colours.h"
#include "tools/program/command.h"

#include <vector>

namespace reradiant {

void add_covariance_options(Command& command, ColourOptions& options);

/// Sets the intervals of the one sample whose covariance was given; nothing where none was. Input
/// Error where it is not that matrix's, for a material, and for several samples.
void add_intervals(const ColourOptions& options, std::vector<SeenSample>& samples);

} // namespace reradiant
