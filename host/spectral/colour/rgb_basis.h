#pragma once

#include "reradiant/spectrum.h"

#include <array>

namespace reradiant {

/// Spectra P_r, P_g, P_b that linear sRGB values stand for: rho = r P_r + g P_g + b P_b. Each is
/// 0..1 (unit 1), they add up to 1 at every wavelength, and under D65 each has the colour of its
/// primary. Mallett and Yuksel 2019, "Spectral Primary Decomposition for Rendering with sRGB
/// Reflectance", section 3.
const std::array<Spectrum, 3>& rgb_basis();

} // namespace reradiant
