#pragma once

#include "reradiant/spectrum.h"

#include <vector>

namespace reradiant {

/// A spectral band that is log-normal in wavenumber (Siano and Metzler 1969), as the bands of dyes
/// are; skew 1 is a Gaussian of wavenumber. Its value is 1 at the peak.
struct WavenumberBand {
    double peak_nm = 500.0;
    double width_per_cm = 2000.0; ///< full width at half maximum
    /// Half width on the red side over that on the blue side: above 1 the tail is red, as of most
    /// emissions, below 1 blue, as of most absorptions.
    double skew = 1.0;
    double height = 1.0; ///< relative to the other bands of a spectrum

    double operator()(double wavelength_nm) const;
};

double wavenumber_per_cm(double wavelength_nm);
/// Width in wavenumber of what is width_nm wide about a wavelength (to first order).
double width_per_cm(double width_nm, double wavelength_nm);

/// The band on the other side of the 0-0 line, equally far and turned around (the mirror-image
/// rule: emission mirrors the absorption of lowest energy).
WavenumberBand mirrored(const WavenumberBand& band, double zero_zero_per_cm);

/// Sum of bands by height, scaled to a largest value of `peak`, as a table in steps of half a
/// nanometre from 150 to 1500 nm, zero outside. std::invalid_argument for no band.
Spectrum spectrum_of_bands(const std::vector<WavenumberBand>& bands, double peak);

} // namespace reradiant
