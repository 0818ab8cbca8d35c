#include "host/spectral/text/wavelength_unit.h"

#include "host/spectral/text/words.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace reradiant {

namespace {

/// Scenes look at spectra in this range of wavelengths.
constexpr double seen_from_nm = 200.0, seen_to_nm = 1000.0;

constexpr WavelengthUnit nanometres{"nm", 1.0};
constexpr WavelengthUnit micrometres{"um", 1e3};
constexpr WavelengthUnit angstroms{"Angstrom", 0.1};
constexpr WavelengthUnit wavenumbers{"1/cm", 1e7, true};
constexpr WavelengthUnit inverse_micrometres{"1/um", 1e3, true};
// CODATA 2018: h c / e in eV nm, c in nm THz.
constexpr WavelengthUnit electron_volts{"eV", 1239.8419843320026, true};
constexpr WavelengthUnit terahertz{"THz", 299792.458, true};

struct UnitWord {
    std::string_view word;
    WavelengthUnit unit;
};
/// Words in small letters, "micro" and the ring of Angstrom as each encoding has them.
constexpr std::array unit_words{
    UnitWord{"nm", nanometres},
    UnitWord{"nanometer", nanometres},
    UnitWord{"nanometers", nanometres},
    UnitWord{"nanometre", nanometres},
    UnitWord{"nanometres", nanometres},
    UnitWord{"um", micrometres},
    UnitWord{"\xc2\xb5m", micrometres},
    UnitWord{"\xce\xbcm", micrometres},
    UnitWord{"\xb5m", micrometres},
    UnitWord{"micron", micrometres},
    UnitWord{"microns", micrometres},
    UnitWord{"micrometer", micrometres},
    UnitWord{"micrometers", micrometres},
    UnitWord{"micrometre", micrometres},
    UnitWord{"micrometres", micrometres},
    UnitWord{"ang", angstroms},
    UnitWord{"angs", angstroms},
    UnitWord{"angstrom", angstroms},
    UnitWord{"angstroms", angstroms},
    UnitWord{"\xc3\x85", angstroms},
    UnitWord{"\xe2\x84\xab", angstroms},
    UnitWord{"\xc5", angstroms},
    UnitWord{"\xc3\xa5ngstr\xc3\xb6m", angstroms},
    UnitWord{"\xc3\x85ngstr\xc3\xb6m", angstroms},
    UnitWord{"pm", WavelengthUnit{"pm", 1e-3}},
    UnitWord{"mm", WavelengthUnit{"mm", 1e6}},
    UnitWord{"m", WavelengthUnit{"m", 1e9}},
    UnitWord{"meter", WavelengthUnit{"m", 1e9}},
    UnitWord{"meters", WavelengthUnit{"m", 1e9}},
    UnitWord{"metre", WavelengthUnit{"m", 1e9}},
    UnitWord{"metres", WavelengthUnit{"m", 1e9}},
    UnitWord{"wavenumber", wavenumbers},
    UnitWord{"wavenumbers", wavenumbers},
    UnitWord{"kayser", wavenumbers},
    UnitWord{"ev", electron_volts},
    UnitWord{"thz", terahertz},
    UnitWord{"hz", WavelengthUnit{"Hz", 2.99792458e17, true}},
};
constexpr std::array<std::string_view, 7> wavenumber_signs{"cm-1",
                                                           "cm^-1",
                                                           "cm**-1",
                                                           "cm^{-1}",
                                                           "1/cm",
                                                           "cm\xe2\x81\xbb\xc2\xb9",
                                                           "cm\xe2\x88\x92"
                                                           "1"};
constexpr std::array<std::string_view, 8> axis_names{
    "wavelength", "wavelengths", "wave", "lambda", "\xce\xbb", "wl", "wvl", "wavenumber"};
constexpr std::array<std::string_view, 12> inverse_micrometre_signs{
    "um-1",        "um^-1",       "um**-1",       "um^{-1}",     "1/um",         "1/\xc2\xb5m",
    "1/\xce\xbcm", "\xc2\xb5m-1", "\xc2\xb5m^-1", "\xce\xbcm-1", "\xce\xbcm^-1", "1/micron"};
constexpr std::array<std::string_view, 35> other_axes{
    "pixel", "pixels",  "px",        "channel",     "channels", "index",    "second",
    "time",  "seconds", "minutes",   "frequency",   "energy",   "band",     "bands",
    "angle", "angles",  "theta",     "temperature", "temp",     "year",     "month",
    "day",   "date",    "hour",      "hours",       "minute",   "position", "distance",
    "depth", "row",     "thickness", "voltage",     "current",  "pressure", "inverse"};
/// Words behind the name of an axis that leave it one: "Pixel number", "Angle of incidence".
constexpr std::array<std::string_view, 10> axis_companions{
    "number", "no", "nr", "index", "in", "of", "deg", "degrees", "id", "axis"};
/// Words of quantities that are no linear scale of light or reflectance.
constexpr std::array<std::string_view, 12> other_quantities{
    "absorbance", "absorbances", "log",      "logarithm", "db",  "decibel",
    "decibels",   "kubelka",     "permille", "permil",    "ppm", "sqrt"};

/// Runs of letters; every byte beyond ASCII counts as one.
std::vector<std::string_view> words_of(std::string_view text) {
    const auto is_letter = [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte >= 0x80 || std::isalpha(byte) != 0;
    };
    std::vector<std::string_view> words;
    for (auto from = std::find_if(text.begin(), text.end(), is_letter); from != text.end();) {
        const auto to = std::find_if_not(from, text.end(), is_letter);
        words.push_back(text.substr(static_cast<std::size_t>(from - text.begin()),
                                    static_cast<std::size_t>(to - from)));
        from = std::find_if(to, text.end(), is_letter);
    }
    return words;
}

bool is_inverse(std::string_view word) {
    const std::string small = lower_case(word);
    return small == "inverse" || small == "reciprocal";
}

/// The inverse of a unit of length that spectra have: centimetres and micrometres.
std::optional<WavelengthUnit> inverse_unit(std::string_view word) {
    const std::string small = lower_case(word);
    if (small == "cm" || small.starts_with("centimet"))
        return wavenumbers;
    for (const UnitWord& known : unit_words)
        if (small == known.word && known.unit.name == micrometres.name)
            return inverse_micrometres;
    return std::nullopt;
}

/// True where a word of the heading stands apart as units do: in brackets, behind a stroke, an
/// underscore or "in".
bool stands_as_unit(std::string_view heading, std::string_view word) {
    const std::string_view before =
        heading.substr(0, static_cast<std::size_t>(word.data() - heading.data()));
    const auto last = before.find_last_not_of(" \t");
    if (last == std::string_view::npos)
        return false;
    return std::string_view("([/_{").find(before[last]) != std::string_view::npos ||
           lower_case(before.substr(0, last + 1)).ends_with(" in");
}

/// The unit that a word of a heading is. A small a is an article, "Sample A", "M" and "PM" are
/// names, so that these letters count where they stand as units do.
std::optional<WavelengthUnit> unit_of_word(std::string_view heading, std::string_view word,
                                           bool is_alone) {
    const bool is_apart = is_alone || stands_as_unit(heading, word);
    if (word == "A")
        return is_apart ? std::optional(angstroms) : std::nullopt;
    const std::string small = lower_case(word);
    if ((small == "m" || small == "pm" || small == "mm") && (word != small || !is_apart))
        return std::nullopt;
    for (const UnitWord& known : unit_words)
        if (small == known.word)
            return known.unit;
    return std::nullopt;
}

/// True for a percent sign that is a unit: "50%" is a number and "not %" says that there is none.
bool is_unit_percent(std::string_view before) {
    const auto last = before.find_last_not_of(" \t");
    if (last == std::string_view::npos)
        return true;
    const std::string lower = lower_case(before.substr(0, last + 1));
    if (lower.ends_with("0-100") || lower.ends_with("0..100") || lower.ends_with("0 to 100"))
        return true;
    return std::isdigit(static_cast<unsigned char>(lower.back())) == 0 && !lower.ends_with("not");
}

/// Returns words on the unit that wavelengths seem to be in when they cannot be in nm.
std::string_view guess(double from, double to) {
    if (to < 10.0)
        return "they look like micrometres";
    if (from > seen_to_nm && to <= 12000.0)
        return "they look like Angstrom or 1/cm";
    return "they look like 1/cm";
}

} // namespace

std::optional<WavelengthUnit> stated_wavelength_unit(std::string_view heading) {
    const std::string lower = lower_case(heading);
    const auto holds = [&](std::string_view sign) { return lower.find(sign) != std::string::npos; };
    if (std::any_of(inverse_micrometre_signs.begin(), inverse_micrometre_signs.end(), holds))
        return inverse_micrometres;
    if (std::any_of(wavenumber_signs.begin(), wavenumber_signs.end(), holds))
        return wavenumbers;
    // "Measured at 0.2 um" is a title.
    if (std::any_of(lower.begin(), lower.end(), [](unsigned char c) { return std::isdigit(c); }))
        return std::nullopt;
    const auto words = words_of(heading);
    if (!words.empty() && is_inverse(words.front()))
        return words.size() == 2 ? inverse_unit(words.back()) : std::nullopt;
    for (const std::string_view word : words)
        if (const auto unit = unit_of_word(heading, word, words.size() == 1))
            return unit;
    return std::nullopt;
}

bool begins_with_axis_name(std::string_view heading) {
    const auto words = words_of(heading);
    return !words.empty() && std::find(axis_names.begin(), axis_names.end(),
                                       lower_case(words.front())) != axis_names.end();
}

bool names_wavelengths(std::string_view heading) {
    return stated_wavelength_unit(heading) || begins_with_axis_name(heading);
}

std::string stated_other_axis(std::string_view heading) {
    const auto words = words_of(heading);
    if (words.empty())
        return {};
    // "Energy saving lamp" and "Second sample" are titles; "Laser energy [mJ]" is an axis.
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (!is_one_of(other_axes, lower_case(words[k])))
            continue;
        const auto behind =
            static_cast<std::size_t>(words[k].data() - heading.data()) + words[k].size();
        const auto next = heading.find_first_not_of(" \t", behind);
        const bool ends = next == std::string_view::npos;
        if ((ends && k < 2) ||
            (!ends && std::string_view("([/_{#.").find(heading[next]) != std::string_view::npos) ||
            (k + 1 < words.size() && is_one_of(axis_companions, lower_case(words[k + 1]))) ||
            is_inverse(words[k]))
            return std::string(words[k]);
    }
    return {};
}

std::string stated_other_quantity(std::string_view heading) {
    const std::string lower = lower_case(heading);
    for (const char* sign :
         {"k/s", "\xe2\x80\xb0", "1-r", "1 - r", "1-t", "1 - t", "optical density"})
        if (lower.find(sign) != std::string::npos)
            return sign;
    for (const std::string_view word : words_of(heading))
        if (std::find(other_quantities.begin(), other_quantities.end(), lower_case(word)) !=
                other_quantities.end() ||
            (word == "OD" && words_of(heading).size() == 1))
            return std::string(word);
    return {};
}

bool states_percent(std::string_view heading) {
    for (auto at = heading.find('%'); at != std::string_view::npos; at = heading.find('%', at + 1))
        if (is_unit_percent(heading.substr(0, at)))
            return true;
    const auto words = words_of(heading);
    for (std::size_t k = 0; k < words.size(); ++k) {
        const std::string small = lower_case(words[k]);
        const bool is_percent =
            small == "percent" || small == "percentage" || small == "pct" ||
            (small == "per" && k + 1 < words.size() && lower_case(words[k + 1]) == "cent");
        if (is_percent && is_unit_percent(heading.substr(
                              0, static_cast<std::size_t>(words[k].data() - heading.data()))))
            return true;
    }
    return false;
}

void require_plausible_range(double from_nm, double to_nm, UnitSource source,
                             const SourcePosition& at) {
    if (to_nm >= seen_from_nm && from_nm <= seen_to_nm)
        return;
    if (source == UnitSource::Stated)
        throw_input_error(at,
                          fmt::format("the spectrum lies from {:.6g} to {:.6g} nm, outside {} to "
                                      "{} nm",
                                      from_nm, to_nm, seen_from_nm, seen_to_nm),
                          "check the unit that its heading states");
    throw_input_error(
        at, fmt::format("wavelengths from {:.6g} to {:.6g} cannot be in nm", from_nm, to_nm),
        fmt::format("{}: convert them{}", guess(from_nm, to_nm),
                    source == UnitSource::Assumed
                        ? ", or name the unit in the heading (nm, um, A, 1/cm)"
                        : ""));
}

} // namespace reradiant
