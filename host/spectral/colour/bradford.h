#pragma once

#include "reradiant/colour.h"

namespace reradiant {

/// Bradford's cone responses (Lam 1985, as ICC.1 annex E gives them) of an XYZ colour. A white that
/// adapt_white can adapt from or to has all three above 0.
std::array<double, 3> bradford_cones(const Xyz& xyz);

} // namespace reradiant
