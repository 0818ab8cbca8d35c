#include "host/render/plan/wavelength_text.h"

#include <fmt/core.h>

#include <charconv>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr int most_comb_wavelengths = 4096;

[[noreturn]] void refuse(const std::string& text, const char* why) {
    throw std::invalid_argument(
        fmt::format("'{}' {}; write comb or comb:N with N from 1 to {}, or hero or hero:N with N "
                    "from 1 to {}",
                    text, why, most_comb_wavelengths, most_hero_wavelengths));
}

} // namespace

WavelengthOptions wavelengths_from_text(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    if (kind != "comb" && kind != "hero")
        refuse(text, "is not known");
    const bool hero = kind == "hero";
    WavelengthOptions options;
    int& wanted = hero ? options.hero_count : options.comb_count;
    wanted = hero ? default_hero_wavelengths : 0;
    if (colon == std::string::npos)
        return options;
    const char* const end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data() + colon + 1, end, wanted);
    if (code != std::errc{} || stop != end || wanted < 1 ||
        wanted > (hero ? most_hero_wavelengths : most_comb_wavelengths))
        refuse(text, "has no valid count");
    return options;
}

} // namespace reradiant
