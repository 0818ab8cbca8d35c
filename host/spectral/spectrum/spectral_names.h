#pragma once

#include "host/spectral/spectrum/rounded_grid.h"

#include <optional>
#include <string>
#include <string_view>

namespace reradiant {

// Reads and writes wavelengths as they stand in the names of channels of spectral EXR images
// (Fichet, Pacanowski and Wilkie, "An OpenEXR Layout for Spectral Images", JCGT 10(3), 2021).

/// Takes "380,000000nm" from the front of the text: decimal comma or point, an exponent or none, m
/// or Hz behind a prefix of the SI. Nothing, and the text as it was, for something else. The same
/// under any LC_NUMERIC.
std::optional<RoundedWavelength> take_named_wavelength(std::string_view& text);

/// "380,000000nm": six digits, as the reference code of the layout writes them.
std::string wavelength_name(double wavelength_nm);

} // namespace reradiant
