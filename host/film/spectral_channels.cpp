#include "host/film/spectral_channels.h"

namespace reradiant {

std::string spectral_channel_name(double wavelength_nm) {
    return "S0." + wavelength_name(wavelength_nm);
}

std::optional<RoundedWavelength> band_of_channel(std::string_view name) {
    if (!name.starts_with("S0."))
        return std::nullopt;
    name.remove_prefix(3);
    const auto named = take_named_wavelength(name);
    return name.empty() ? named : std::nullopt;
}

} // namespace reradiant
