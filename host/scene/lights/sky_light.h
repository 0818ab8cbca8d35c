#pragma once

#include "host/scene/lights/clear_sky.h"
#include "reradiant/scene.h"

namespace reradiant {

/// Full angle under which the sun is seen, at its mean distance.
inline constexpr double SUN_ANGLE_DEG = 0.533;

/// Returns the sun, its disk of the same radiance everywhere: the direct light. `to_sun`: unit.
DirectionalLight sun_light(const ClearSkyLight& light, const Vector3& to_sun);

/// Returns the blue sky: an environment whose image, appended to nothing, is stored in `image`. Its
/// irradiance on a level plane is that of `light`; its distribution over directions the standard
/// one of a clear sky (CIE S 011:2003, type 12), of which haze has the part that is brightest about
/// the sun, air the rest; light between ground and sky comes from everywhere alike. Dark below the
/// horizon.
EnvironmentLight blue_sky_light(const ClearSkyLight& light, const Vector3& to_sun, Image& image);

} // namespace reradiant
