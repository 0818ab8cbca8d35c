#pragma once

#include "tools/commands/colour/seen_colours.h"

#include <string>
#include <vector>

namespace reradiant {

/// Fields of all samples under all lamps for one observer, as an SVG element: a row a sample, a
/// column a lamp. With a reference a field's right half shows that. A corner is cut off where the
/// screen cannot show the colour.
std::string swatches(const std::vector<SeenSample>& samples, Observer observer,
                     const ColourOptions& options);

} // namespace reradiant
