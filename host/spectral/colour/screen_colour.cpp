#include "host/spectral/colour/screen_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

/// Rounding; more is beyond the gamut.
constexpr double in_gamut = 1e-3;

/// IEC 61966-2-1.
double srgb_encoded(double linear) {
    const double value = std::clamp(linear, 0.0, 1.0);
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
}

} // namespace

ScreenColour screen_colour(const MatrixColour& colour) {
    const Xyz d65 = linear_srgb_to_xyz({1.0, 1.0, 1.0});
    Xyz xyz = colour.xyz, white = colour.white;
    for (std::size_t c = 0; c < 3; ++c) {
        xyz[c] /= 100.0;
        white[c] /= 100.0;
    }
    const auto rgb = xyz_to_linear_srgb(adapt_white(xyz, white, d65));
    ScreenColour shown{"#", false};
    for (const double value : rgb) {
        shown.is_clipped = shown.is_clipped || !(value >= -in_gamut && value <= 1.0 + in_gamut);
        shown.hex +=
            fmt::format("{:02x}", static_cast<int>(std::lround(255 * srgb_encoded(value))));
    }
    return shown;
}

} // namespace reradiant
