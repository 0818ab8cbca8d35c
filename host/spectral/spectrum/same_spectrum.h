#pragma once

#include "reradiant/spectrum.h"

namespace reradiant {

/// True when two spectra have the same values, to the bit: at the nodes of their tables, within
/// their Gaussians, on a comb from 100 to 3000 nm, and in their lines.
bool same_spectrum(const Spectrum& a, const Spectrum& b);

} // namespace reradiant
