#pragma once

#include "reradiant/spectrum.h"

namespace reradiant {

// Spectra made of others, point by point. What is not linear in its parts becomes a table of 1 nm
// and all nodes, from 200 to 1200 nm and as far as the parts have nodes; it is constant outside.

/// Returns the product of two spectra. A box of one becomes a box with the mean of the other over
/// it, so that lines of a lamp behind a filter stay lines.
Spectrum product(const Spectrum& a, const Spectrum& b);

/// Returns a spectrum with values below `low` raised to it and those above `high` lowered. Boxes
/// stay boxes, the height of each cut by itself.
Spectrum cut_values(const Spectrum& spectrum, double low, double high);

} // namespace reradiant
