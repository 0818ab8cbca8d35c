#pragma once

#include "host/study/study/study_file.h"
#include "reradiant/measure.h"

#include <Eigen/Core>

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace reradiant {

/// A `SeenColour` is what an eye and an instrument see at one pair of directions under one
/// illuminant.
struct SeenColour {
    std::string illuminant;
    double theta_i_deg = 0.0, theta_o_deg = 0.0, phi_deg = 0.0;
    /// Perfect diffuser Y = 100; Lab against the illuminant's own white. NaN, as are luminous flux
    /// and polar curves, where that white is all but dark.
    std::array<double, 3> xyz{}, lab{};
    /// Total radiance factor of each band: of reflected and fluorescent light against the perfect
    /// diffuser's. NaN where the illuminant is dark (below 1e-6 of its strongest band). May exceed
    /// 1.
    std::vector<double> beta_t;
    /// Photons re-radiated over photons absorbed, by the whole sample, hemispherically, at the
    /// bands that excite; NaN when nothing fluoresces.
    double quantum_yield = 0.0;
    /// Luminous flux into all directions, of light at the first theta_i, the mirror's and what goes
    /// straight on included; the lamp's is 100. NaN for what an opaque sample has not.
    double reflected = std::numeric_limits<double>::quiet_NaN(), transmitted = reflected,
           guided = reflected;
};

/// Luminance factor in the plane of incidence, under the first illuminant.
struct PolarCurve {
    double theta_i_deg = 0.0;
    /// -85..85, negative on the side that the light comes from; of a sheet -180..180, with what it
    /// transmits from 95 on and NaN in between.
    std::vector<double> angle_deg;
    std::vector<double> diffuse, total;
};

struct CellMeasurement {
    WavelengthGrid bands;
    std::vector<SeenColour> colours;
    /// Directional-hemispherical at the first theta_i, per-band: what the substrate and slabs send
    /// back.
    Eigen::MatrixXd matrix;
    std::vector<double> specular; ///< likewise, of light that met neither
    /// Likewise of a sheet, on its far side, and what it guides for ever; empty for others.
    Eigen::MatrixXd transmitted, guided;
    std::vector<double> straight; ///< what no slab scattered, on the far side

    bool of_sheet() const { return transmitted.size() > 0; }
    std::vector<PolarCurve> polar;
    std::vector<std::string> notes;
};

/// A lamp that colours are seen under.
struct NamedIlluminant {
    std::string name;
    Spectrum spectrum;
};

/// Measures a material as a study asks. Input Error as measure_material has it.
CellMeasurement measure_cell(const Material& material, const StudyMeasuring& measuring,
                             const std::vector<NamedIlluminant>& illuminants);

} // namespace reradiant
