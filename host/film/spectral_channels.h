#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace reradiant {

/// Channel of the unpolarised radiance at a wavelength, "S0.380,000000nm": decimal comma and six
/// digits as the reference code of Fichet, Pacanowski and Wilkie (JCGT 2021) writes them, the
/// same under any LC_NUMERIC.
std::string spectral_channel_name(double wavelength_nm);

/// Wavelength of an S0 channel in nm; empty for any other name. Does not look at the locale.
std::optional<double> wavelength_of_channel(std::string_view name);

} // namespace reradiant
