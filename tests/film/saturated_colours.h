#pragma once

#include "reradiant/colour.h"

#include <Eigen/Core>

#include <vector>

/// Colours beyond what sRGB shows, and what is lost of their hue where they are brought into it.
namespace reradiant::test {

/// Columns are XYZ of the primaries of linear sRGB.
Eigen::Matrix3d srgb_primaries();
/// XYZ of its white.
Xyz srgb_white();

/// The colour with its channels of linear sRGB cut off at 0 and 1.
Xyz clipped_to_srgb(const Xyz& xyz);
bool is_in_srgb(const Xyz& xyz, double tolerance = 1e-6);

/// Hue angle of CIELAB in degrees, and the hue term of CIEDE2000 (Sharma, Wu and Dalal 2005,
/// equations 7 to 15 and 20), between two colours.
struct HueError {
    double angle_deg, term;
};
HueError hue_error(const Xyz& xyz, const Xyz& other);

/// A thousand colours that sRGB does not hold: emission bands of dyes, 10 to 60 nm wide (full width
/// at half the height is 24 to 141 nm), on a little white light.
std::vector<Xyz> saturated_colours();

} // namespace reradiant::test
