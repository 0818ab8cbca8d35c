#include "host/film/spectral_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace reradiant {

std::string spectral_channel_name(double wavelength_nm) {
    std::string number = fmt::format("{:.6f}", wavelength_nm);
    std::replace(number.begin(), number.end(), '.', ',');
    return "S0." + number + "nm";
}

std::optional<double> wavelength_of_channel(std::string_view name) {
    if (!name.starts_with("S0.") || !name.ends_with("nm") || name.size() <= 5)
        return std::nullopt;
    std::string number(name.substr(3, name.size() - 5));
    std::replace(number.begin(), number.end(), ',', '.');
    double wavelength_nm = 0.0;
    const char* const end = number.data() + number.size();
    const auto [stop, error] = std::from_chars(number.data(), end, wavelength_nm);
    if (error != std::errc() || stop != end || !std::isfinite(wavelength_nm) || wavelength_nm <= 0)
        return std::nullopt;
    return wavelength_nm;
}

} // namespace reradiant
