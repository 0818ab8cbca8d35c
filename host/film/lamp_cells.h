#pragma once

#include "reradiant/spectral_image.h"
#include "reradiant/spectrum.h"

#include <vector>

namespace reradiant {

/// Means of a lamp over cells of 1 nm, as layers and pages keep it: lamp_cells of them.
std::vector<double> lamp_cell_means(const Spectrum& lamp);

} // namespace reradiant
