#pragma once

#include "kernels/core/shared.h"
#include "reradiant/scene.h"

#include <cstdint>
#include <vector>

namespace reradiant {

/// Appends an image's texels and the tables that its directions are sampled from. A texel's share
/// is its colour's sum, smoothed over its neighbours as bilinear interpolation will smooth it,
/// times the sine of its polar angle. `light` is not filled in.
EnvironmentRecord append_environment_image(const Image& image, double rotation_deg,
                                           std::vector<float>& tables);

/// Floats that append_environment_image appends.
inline std::uint64_t environment_image_floats(const Image& image) {
    const auto width = static_cast<std::uint64_t>(image.width),
               height = static_cast<std::uint64_t>(image.height);
    return (3 + 1 + 1) * width * height + height; // colours, density, conditional; marginal
}

/// Mean of red, green and blue over the sphere.
double mean_over_sphere(const Image& image);

} // namespace reradiant
