#pragma once

#include "reradiant/scene.h"

#include <array>
#include <vector>

namespace reradiant {

/// A cloudless day at sea level.
struct ClearSky {
    double sun_elevation_deg = 45.0; ///< above 0, at most 90
    double aerosol_depth = 0.1;      ///< optical depth of haze at 500 nm, straight up
    double ground_albedo = 0.2;      ///< lights the sky from below; 0 to below 1
    double ozone_cm = 0.344;         ///< atm-cm
    double water_cm = 1.42;          ///< precipitable
};

/// What arrives at the ground, W m^-2 per nm at `nm`, 300 to 1100 nm.
struct ClearSkyLight {
    std::vector<double> nm;
    std::vector<double> direct; ///< of the sun, on a plane that faces it
    /// On a level plane: light that air scattered, that haze scattered, and that went to and fro
    /// between ground and sky.
    std::array<std::vector<double>, 3> diffuse;
};

/// Bird and Riordan 1984, "Simple Solar Spectral Model for Direct and Diffuse Irradiance on
/// Horizontal and Tilted Planes at the Earth's Surface for Cloudless Atmospheres", SERI TR-215-2436
/// (with the air mass of Kasten and Young 1989 and the constants of spectrl2_2.c, its authors'
/// later program); the sun at its mean distance. Numbers in brackets are the report's equations.
ClearSkyLight clear_sky_light(const ClearSky& sky);

/// Optical depth of haze at 500 nm of a turbidity (Preetham, Shirley and Smits 1999, "A Practical
/// Analytic Model for Daylight", appendix 1: beta = 0.04608 T - 0.04586 at 1 um, alpha = 1.3).
double aerosol_depth_of_turbidity(double turbidity);

} // namespace reradiant
