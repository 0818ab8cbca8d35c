#pragma once

#include "host/spectral/grid.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reradiant {

// How channels of spectral EXR images write wavelengths (Fichet, Pacanowski and Wilkie, "An OpenEXR
// Layout for Spectral Images", JCGT 10(3), 2021).

/// A wavelength out of a channel's name.
struct NamedWavelength {
    double nm = 0.0;
    double rounding_nm = 0.0; ///< what half a unit of the last digit stands for
};

/// Takes "380,000000nm" from the front of the text: decimal comma or point, an exponent or none, m
/// or Hz behind a prefix of the SI. Nothing, and the text as it was, for something else. The same
/// under any LC_NUMERIC.
std::optional<NamedWavelength> take_named_wavelength(std::string_view& text);

/// "380,000000nm": six digits, as the reference code of the layout writes them.
std::string wavelength_name(double wavelength_nm);

/// Grid of ascending wavelengths whose names were rounded. They must lie in equal steps within
/// their roundings where these are small against the step, else exactly. Of the grids that fit, the
/// one with first centre and step in the largest whole parts of a nm (to 1/64), else that between
/// the ends. Throws std::invalid_argument as grid_from_centres does.
WavelengthGrid grid_from_names(const std::vector<NamedWavelength>& wavelengths,
                               double step_of_single_nm = 1.0);

} // namespace reradiant
