#pragma once

#include "reradiant/spectrum.h"
#include "reradiant/wavelength_grid.h"

#include <array>
#include <string>
#include <vector>

namespace reradiant {

using Xyz = std::array<double, 3>;

/// CIE 1931 2 degree colour matching functions (1 nm table, data file with provenance).
/// Outside 360-830 nm they are zero.
struct ColourMatching {
    std::vector<double> wavelengths_nm, x, y, z;
};
const ColourMatching& cie_1931_2_degree();

/// Weights w[band][channel] with XYZ = sum_band w * radiance[band], scaled so that unit spectral
/// radiance at every wavelength has Y = 1. Each band's weight is the mean of the colour matching
/// functions over its cell times the step over the integral of y.
std::vector<Xyz> xyz_weights(const WavelengthGrid& grid);

/// XYZ of a spectrum in the same scale (Y of unit radiance = 1), exact for boxes.
Xyz xyz_of(const Spectrum& spectrum);

/// CIE standard illuminant by name (A to C, D50 to D75, E, ID50, ID65, FL1..FL12,
/// FL3.1..FL3.15, HP1..HP5, LED-B1..LED-V2), relative spectral power as in the CIE table (100 at
/// 560 nm for A and D65). std::invalid_argument lists what exists.
Spectrum illuminant(const std::string& name);
/// Returns the CIE standard illuminant of that name, scaled to the luminance `y` in the scale of
/// xyz_of.
Spectrum illuminant_with_luminance(const std::string& name, double y);

std::array<double, 3> xyz_to_lab(const Xyz& xyz, const Xyz& white);
/// CIEDE2000 (Sharma, Wu, Dalal 2005) between two Lab colours, kL = kC = kH = 1.
double ciede2000(const std::array<double, 3>& lab1, const std::array<double, 3>& lab2);
/// Linear sRGB (D65 white, IEC 61966-2-1) from XYZ with Y of white = 1. Not clamped.
std::array<double, 3> xyz_to_linear_srgb(const Xyz& xyz);
Xyz linear_srgb_to_xyz(const std::array<double, 3>& rgb);
/// Bradford chromatic adaptation from one white to another.
Xyz adapt_white(const Xyz& xyz, const Xyz& from_white, const Xyz& to_white);

/// A smooth reflectance in [0, 1] whose colour under D65 is the linear sRGB triple, by a
/// published method (named in the implementation). Components in [0, 1].
Spectrum reflectance_from_rgb(const std::array<double, 3>& rgb);

} // namespace reradiant
