#include "host/spectral/wavelength_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace reradiant {

namespace {

/// Where scenes look at spectra.
constexpr double seen_from_nm = 200.0, seen_to_nm = 1000.0;

constexpr WavelengthUnit nanometres{"nm", 1.0};
constexpr WavelengthUnit micrometres{"um", 1e3};
constexpr WavelengthUnit angstroms{"Angstrom", 0.1};
constexpr WavelengthUnit wavenumbers{"1/cm", 1e7, true};
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
constexpr std::array<std::string_view, 12> other_axes{"pixel",    "pixels", "px",        "channel",
                                                      "channels", "index",  "second",    "seconds",
                                                      "minutes",  "time",   "frequency", "energy"};

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
        return c < 0x80 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c);
    });
    return lower;
}

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

bool begins_with_axis_name(const std::vector<std::string_view>& words) {
    return !words.empty() && std::find(axis_names.begin(), axis_names.end(),
                                       lower_case(words.front())) != axis_names.end();
}

/// What the numbers look like in another unit than nm.
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
    for (const std::string_view sign : wavenumber_signs)
        if (lower.find(sign) != std::string::npos)
            return wavenumbers;
    // "Measured at 0.2 um" is a title.
    if (std::any_of(lower.begin(), lower.end(), [](unsigned char c) { return std::isdigit(c); }))
        return std::nullopt;
    const auto words = words_of(heading);
    const bool names_axis = words.size() == 1 || begins_with_axis_name(words);
    for (const std::string_view word : words) {
        // A small a is an article, and "Sample A" and "M" are names.
        if (word == "A" && names_axis)
            return angstroms;
        const std::string small = lower_case(word);
        for (const UnitWord& known : unit_words)
            if (small == known.word && (small != "m" || (word == "m" && names_axis)))
                return known.unit;
    }
    return std::nullopt;
}

bool names_wavelengths(std::string_view heading) {
    return stated_wavelength_unit(heading) || begins_with_axis_name(words_of(heading));
}

std::string stated_other_axis(std::string_view heading) {
    for (const std::string_view word : words_of(heading))
        if (std::find(other_axes.begin(), other_axes.end(), lower_case(word)) != other_axes.end())
            return std::string(word);
    return {};
}

bool states_percent(std::string_view heading) {
    if (heading.find('%') != std::string_view::npos)
        return true;
    const auto words = words_of(heading);
    return std::any_of(words.begin(), words.end(), [](std::string_view word) {
        const std::string small = lower_case(word);
        return small == "percent" || small == "percentage" || small == "pct";
    });
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
