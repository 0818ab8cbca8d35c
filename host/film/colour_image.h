#pragma once

#include "reradiant/colour.h"

#include <vector>

namespace reradiant {

struct SpectralImage;

/// CIE 1931 XYZ of every pixel, (height, width); unit radiance at every wavelength has Y = 1.
std::vector<Xyz> xyz_image(const SpectralImage& image);

} // namespace reradiant
