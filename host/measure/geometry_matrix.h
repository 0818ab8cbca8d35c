#pragma once

#include "reradiant/reradiation.h"
#include "reradiant/scene.h"

#include <filesystem>
#include <string>

namespace reradiant {

/// A `ViewingGeometry` says where an instrument's light comes from and where it looks.
struct ViewingGeometry {
    enum class Kind { Directional, DirectionalHemispherical, HemisphericalDirectional };
    Kind kind = Kind::Directional;
    double theta_i_deg = 45.0, theta_o_deg = 0.0; ///< of the two what is directional
    double phi_deg = 0.0; ///< azimuth of the view from the incidence; 180 is the mirror's side
    /// Hemispherical geometries: the mirror's reflection is kept, or goes into a trap.
    bool specular_included = true;
    std::string name = "45/0"; ///< as it was asked for
};

/// The half angle of the trap's port as the sample sees it, around the mirror's direction. What a
/// rough surface reflects specularly into it is excluded with the mirror; the diffuse light that
/// the port takes away is given back, as an instrument's calibration on a white does.
inline constexpr double specular_port_deg = 5.0;

/// Reads 45/0, 0/45, 8/d, d/8 (specular included), 8/de, de/8 (excluded), or
/// THETA_I:THETA_O[:PHI] in degrees, 0 <= theta < 90; std::invalid_argument lists these, or says
/// that a direction lies below the horizon.
ViewingGeometry viewing_geometry(const std::string& text);

/// The radiance factors of a layered material as a matrix of the material's own bands: what a
/// perfect diffuser's radiance is multiplied by, per band of excitation; exact at the band centres
/// where a closed model does the material, else by the walk with its default count of paths. The
/// mirror's reflection is part of no directional geometry. Input Error without a place for what
/// the model cannot do, among it excluded specular light where the material is walked.
ReradiationMatrix geometry_matrix(const Material& material, const ViewingGeometry& geometry);
/// The same of a material that was read from a file, where an Error without a place is placed.
ReradiationMatrix geometry_matrix_of(const std::filesystem::path& file, const Material& material,
                                     const ViewingGeometry& geometry);

} // namespace reradiant
