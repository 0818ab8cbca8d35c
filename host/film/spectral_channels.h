#pragma once

#include "host/spectral/spectrum/spectral_names.h"

#include <optional>
#include <string>
#include <string_view>

namespace reradiant {

/// Channel of the unpolarised radiance at a wavelength, "S0.380,000000nm".
std::string spectral_channel_name(double wavelength_nm);

/// Wavelength of an S0 channel; empty for any other name.
std::optional<RoundedWavelength> band_of_channel(std::string_view name);

} // namespace reradiant
