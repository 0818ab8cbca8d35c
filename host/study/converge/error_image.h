#pragma once

#include "reradiant/spectral_image.h"

#include <filesystem>
#include <vector>

namespace reradiant {

/// relMSE of every pixel, (height, width): the mean over bands of d^2 / (ref^2 + 0.01 mean(ref)^2),
/// whose mean is `compare`'s. The images must be alike.
std::vector<double> pixel_errors(const SpectralImage& image, const SpectralImage& reference);

/// Decades that an error image shows beneath its brightest colour.
inline constexpr double error_image_decades = 4.0;

/// Errors as a picture in the sequential colours of plots: lightest at `brightest` and above,
/// darkest four decades beneath.
void write_error_png(const std::filesystem::path& file, int width, int height,
                     const std::vector<double>& errors, double brightest);

} // namespace reradiant
