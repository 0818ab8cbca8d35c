#pragma once

#include "reradiant/colour.h"

#include <array>
#include <optional>
#include <vector>

namespace reradiant {

/// Median of the largest channel of linear sRGB over pixels that are not black; 0 where all are.
/// Highlights that cover less than half of what is seen do not count.
double body_level(const std::vector<Xyz>& pixels);

/// Exposure, EV in tenths, that shows such a body well: 0 where it lies between a tenth and 0.9 of
/// white as it is, or is black; else it is shown at 0.6 of white.
double exposure_of_level(double body_level);

/// Medians of the CIE 1931 x and y of the pixels that are neither dark nor lamps or highlights:
/// those with a luminance from a twentieth of the 99th percentile (of what is not black) up to it.
/// Saturated bodies do not count where they cover less than half of these pixels. Empty where all
/// are black.
std::optional<std::array<double, 2>> median_chromaticity(const std::vector<Xyz>& pixels);

} // namespace reradiant
