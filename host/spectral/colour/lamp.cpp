#include "host/spectral/colour/lamp.h"

#include "host/spectral/text/number_table.h"
#include "reradiant/colour.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"
#include "reradiant/spectral_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace reradiant {

namespace {

constexpr double lowest_nm = 200.0, highest_nm = 2000.0;
constexpr double share_from_nm = 300.0, share_to_nm = 830.0, ultraviolet_to_nm = 400.0;
/// The standard asks for no substantial light below 400 nm of condition M2.
constexpr double m2_from_nm = 400.0;

[[noreturn]] void refuse(const std::string& sentence) {
    throw std::invalid_argument(sentence);
}

std::vector<std::string_view> split(std::string_view text, char mark) {
    std::vector<std::string_view> parts;
    for (std::size_t at; (at = text.find(mark)) != std::string_view::npos;
         text.remove_prefix(at + 1))
        parts.push_back(text.substr(0, at));
    parts.push_back(text);
    return parts;
}

double number(std::string_view text, std::string_view of, double low, double high) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        refuse(fmt::format("'{}' in lamp '{}' is not a number", text, of));
    if (value < low || value > high)
        refuse(fmt::format("{:.10g} in lamp '{}' is not between {:.10g} and {:.10g}", value, of,
                           low, high));
    return value;
}

Spectrum with_luminance(const Spectrum& shape, double y) {
    return shape.scaled(y / xyz_of(shape)[1]);
}

Spectrum line(const std::vector<std::string_view>& parts, std::string_view text, double factor) {
    const double nm = number(parts[1], text, lowest_nm, highest_nm);
    const double width = parts.size() > 2 ? number(parts[2], text, 1e-3, 1e3) : 1.0;
    return Spectrum::line(nm, width, factor);
}

/// A term without its factor.
Spectrum source(std::string_view text, double factor) {
    const std::vector<std::string_view> parts = split(text, ':');
    if (parts.size() == 2 && parts[0] == "D")
        return cie_daylight(number(parts[1], text, 0.0, 1e9)).scaled(factor);
    if (parts.size() == 2 && parts[0] == "P")
        return with_luminance(Spectrum::blackbody(number(parts[1], text, 500.0, 1e6), 1.0), factor);
    if ((parts.size() == 2 || parts.size() == 3) && parts[0] == "L")
        return line(parts, text, factor);
    try {
        return illuminant_with_luminance(std::string(text), factor);
    } catch (const std::invalid_argument& error) {
        refuse(fmt::format("{}; D:KELVIN (CIE daylight), P:KELVIN (black body), L:NM[:WIDTH] (line)"
                           ", M0, M1, M2 (ISO 13655), and sums such as D65+0.3*L:365",
                           error.what()));
    }
}

Spectrum term(std::string_view text) {
    const std::size_t star = text.find('*');
    if (star == std::string_view::npos)
        return source(text, 1.0);
    return source(text.substr(star + 1), number(text.substr(0, star), text, 1e-9, 1e9));
}

} // namespace

Lamp lamp_from_text(const std::string& text) {
    if (text == "M0")
        return {.name = text, .light = illuminant("A"), .weighted_by = illuminant("D50")};
    if (text == "M1")
        return {.name = text, .light = illuminant("D50")};
    if (text == "M2")
        return {text, cut_to(illuminant("A"), m2_from_nm, highest_nm), illuminant("D50"),
                m2_from_nm};
    if (text.find_first_of("+*:") == std::string::npos && !text.empty()) {
        source(text, 1.0); // refuses what there is not
        return {.name = text, .light = illuminant(text)};
    }
    Lamp lamp{.name = text, .light = {}};
    for (const std::string_view part : split(text, '+'))
        lamp.light += term(part);
    return lamp;
}

Lamp read_lamp(const std::filesystem::path& file) {
    return lamp_of_spectrum(file.filename().string(), read_spectrum(file), {file.string()});
}

Lamp lamp_of_spectrum(const std::string& name, const Spectrum& data, const SourcePosition& at) {
    const double from = std::max(data.data_from_nm(), 1.0),
                 to = std::min(data.data_to_nm(), share_to_nm + highest_nm);
    if (!(to > from))
        throw_input_error(at, "a lamp needs more than one wavelength");
    Lamp lamp{.name = name, .light = cut_to(data, from, to)};
    for (const double nm : data.breakpoints_nm())
        if (data(nm) < 0.0)
            throw_input_error(
                at, fmt::format("the lamp is negative at {:.6g} nm ({:.6g})", nm, data(nm)),
                "power is at least 0; take the instrument's dark signal away");
    if (!(xyz_of(lamp.light)[1] > 0.0))
        throw_input_error(at, "the lamp gives no visible light",
                          "a colour is relative to a white surface under the same light");
    return lamp;
}

Lamp without_ultraviolet(const Lamp& lamp, double nm) {
    if (!(nm >= lowest_nm && nm <= 780.0))
        refuse(fmt::format("a cut at {:.6g} nm is not between 200 and 780 nm", nm));
    if (lamp.light.is_zero_within(0.0, nm))
        return lamp;
    return {lamp.name, cut_to(lamp.light, nm, highest_nm), lamp.weighted_by, nm};
}

Spectrum cie_daylight(double kelvin) {
    constexpr double lowest_kelvin = 4000.0, middle_kelvin = 7000.0, highest_kelvin = 25000.0;
    if (!(kelvin >= lowest_kelvin && kelvin <= highest_kelvin))
        refuse(fmt::format("CIE daylight of {:.6g} K is not defined; it is from 4000 to 25000 K",
                           kelvin));
    const double t = 1e3 / kelvin; // equations 4.8 and 4.9
    const double x = kelvin <= middle_kelvin
                         ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                         : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
    const double y = (-3.0 * x + 2.870) * x - 0.275;
    const auto rounded = [](double value) { return std::round(1e3 * value) / 1e3; };
    const double divisor = 0.0241 + 0.2562 * x - 0.7341 * y;
    const double m1 = rounded((-1.3515 - 1.7703 * x + 5.9114 * y) / divisor);
    const double m2 = rounded((0.0300 - 31.4424 * x + 30.0717 * y) / divisor);
    const NumberTable table =
        read_number_table(spectra_directory() / "daylight" / "components.csv", 4);
    std::vector<double> power;
    for (std::size_t k = 0; k < table.columns[0].size(); ++k)
        power.push_back(std::max(0.0, table.columns[1][k] + m1 * table.columns[2][k] +
                                          m2 * table.columns[3][k]));
    const Spectrum shape = cut_to(Spectrum::table(table.columns[0], std::move(power)),
                                  table.columns[0].front(), table.columns[0].back());
    return with_luminance(shape, 1.0);
}

double ultraviolet_share(const Spectrum& lamp) {
    const auto power = [&](double from, double to) { return lamp.average(from, to) * (to - from); };
    const double all = power(share_from_nm, share_to_nm);
    if (!(all > 0.0))
        return std::numeric_limits<double>::quiet_NaN();
    return power(share_from_nm, ultraviolet_to_nm) / all;
}

} // namespace reradiant
