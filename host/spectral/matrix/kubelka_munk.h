#pragma once

#include "reradiant/reradiation.h"
#include "reradiant/spectrum.h"

#include <limits>
#include <vector>

namespace reradiant {

/// Absorption and scattering of a pigment per unit of thickness, at concentration 1 (Duncan 1940:
/// those of a mixture are sums weighted by concentration).
struct Pigment {
    Spectrum absorption, scattering;
    double concentration = 1.0;
};

/// A dye absorbs K photons of diffuse light per unit of thickness, at concentration 1, and emits
/// a share quantum_yield of them at longer wavelengths, as many upwards as downwards.
struct Dye {
    Spectrum absorption; ///< K, as of a pigment
    Spectrum emission;   ///< relative radiant power per nm
    double quantum_yield = 1.0;
    double concentration = 1.0;
};

/// A layer of pigments and dyes on a backing. The two fluxes of Kubelka and Munk are those inside
/// the medium: what its surface does is up to the stack above.
struct PigmentLayer {
    static constexpr double OPAQUE = std::numeric_limits<double>::infinity();

    std::vector<Pigment> pigments;
    std::vector<Dye> dyes;
    double thickness = OPAQUE;
    Spectrum backing; ///< reflectance behind it, 0..1

    double absorption(double wavelength_nm) const; ///< of pigments and dyes, per unit of thickness
    double scattering(double wavelength_nm) const;
    /// True when some dye emits.
    bool is_fluorescent() const;
};

/// Reflectance of a layer with absorption k and scattering s per unit of thickness over a backing
/// (Kubelka 1948; opaque: Kubelka and Munk 1931, 1 + k/s - sqrt((k/s)^2 + 2 k/s)). Unit 1.
/// std::invalid_argument when it is opaque with neither absorption nor scattering: light that
/// enters it never returns and is never lost.
double kubelka_munk_reflectance(double k, double s, double thickness, double backing);

/// Reflectance of the layer from 200 to 1000 nm by 1 nm, the dyes absorbing only; a constant when
/// nothing depends on wavelength.
Spectrum kubelka_munk_spectrum(const PigmentLayer& layer);

/// Re-radiation matrix of the layer, per-band, on one grid for emission and excitation. Light of
/// the dyes is scattered, re-absorbed and re-emitted within the layer, to every order.
/// std::invalid_argument as kubelka_munk_reflectance, and for a dye with a negative emission.
ReradiationMatrix kubelka_munk_matrix(const PigmentLayer& layer, const WavelengthGrid& grid);

} // namespace reradiant
