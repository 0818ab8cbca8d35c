#include "host/spectral/spectrum/spectral_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace reradiant {

namespace {

constexpr double speed_of_light_nm_hz = 299792458.0 * 1e9;
constexpr double longest_nm = 1e6;
constexpr std::string_view digits = "0123456789";

struct Prefix {
    std::string_view letters;
    double factor;
};
constexpr Prefix prefixes[] = {{"Y", 1e24}, {"Z", 1e21},  {"E", 1e18},  {"P", 1e15}, {"T", 1e12},
                               {"G", 1e9},  {"M", 1e6},   {"k", 1e3},   {"h", 1e2},  {"da", 1e1},
                               {"", 1.0},   {"d", 1e-1},  {"c", 1e-2},  {"m", 1e-3}, {"u", 1e-6},
                               {"n", 1e-9}, {"p", 1e-12}, {"f", 1e-15}, {"a", 1e-18}};

/// A number as it is written, and what half a unit of its last digit is.
struct WrittenNumber {
    double value = 0.0, half_unit = 0.0;
};

std::optional<WrittenNumber> take_number(std::string_view& text) {
    const std::size_t whole = std::min(text.find_first_not_of(digits), text.size());
    std::size_t end = whole, decimals = 0;
    if (end < text.size() && (text[end] == ',' || text[end] == '.')) {
        const std::size_t after = text.find_first_not_of(digits, end + 1);
        decimals = std::min(after, text.size()) - end - 1;
        end += 1 + decimals;
    }
    if (whole + decimals == 0)
        return std::nullopt;
    // An E without digits behind it is the prefix exa.
    int exponent = 0;
    if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
        const bool plus = text.substr(end + 1).starts_with('+');
        const char* const first = text.data() + end + 1 + (plus ? 1 : 0);
        const auto [stop, error] = std::from_chars(first, text.data() + text.size(), exponent);
        if (error == std::errc())
            end = static_cast<std::size_t>(stop - text.data());
    }
    std::string number(text.substr(0, end));
    std::replace(number.begin(), number.end(), ',', '.');
    number.erase(std::remove(number.begin(), number.end(), '+'), number.end());
    WrittenNumber written;
    const auto [stop, error] =
        std::from_chars(number.data(), number.data() + number.size(), written.value);
    if (error != std::errc() || stop != number.data() + number.size())
        return std::nullopt;
    written.half_unit = 0.5 * std::pow(10.0, exponent - static_cast<double>(decimals));
    text.remove_prefix(end);
    return written;
}

/// The unit's factor to m or Hz; the unit ends at a point or with the text.
std::optional<double> take_unit(std::string_view& text, bool& is_frequency) {
    const std::size_t end = std::min(text.find('.'), text.size());
    std::string_view unit = text.substr(0, end);
    is_frequency = unit.ends_with("Hz");
    if (!is_frequency && !unit.ends_with('m'))
        return std::nullopt;
    unit.remove_suffix(is_frequency ? 2 : 1);
    for (const Prefix& prefix : prefixes)
        if (unit == prefix.letters) {
            text.remove_prefix(end);
            return prefix.factor;
        }
    return std::nullopt;
}

} // namespace

std::optional<RoundedWavelength> take_named_wavelength(std::string_view& text) {
    std::string_view rest = text;
    const auto number = take_number(rest);
    bool is_frequency = false;
    const auto factor = number ? take_unit(rest, is_frequency) : std::nullopt;
    if (!factor)
        return std::nullopt;
    // 380 nm is 380, not 380 * 1e-9 * 1e9.
    const double to_nm = *factor == 1e-9 ? 1.0 : *factor * 1e9;
    RoundedWavelength named{number->value * to_nm, number->half_unit * to_nm};
    if (is_frequency) {
        const double frequency_hz = number->value * *factor;
        named.nm = speed_of_light_nm_hz / frequency_hz;
        named.rounding_nm = named.nm * number->half_unit / number->value;
    }
    if (!(named.nm > 0.0 && named.nm <= longest_nm))
        return std::nullopt;
    text = rest;
    return named;
}

std::string wavelength_name(double wavelength_nm) {
    std::string text = fmt::format("{:.6f}nm", wavelength_nm); // fmt knows no locale
    std::replace(text.begin(), text.end(), '.', ',');
    return text;
}

} // namespace reradiant
