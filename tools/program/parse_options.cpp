#include "tools/program/parse_options.h"

#include "host/render/plan/wavelength_text.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"
#include "reradiant/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace reradiant {

namespace {

std::vector<std::string_view> split_at_colons(std::string_view text) {
    std::vector<std::string_view> parts;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(':', start), text.size());
        parts.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

template <typename T>
std::optional<T> number(std::string_view text) {
    T value{};
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size())
        return std::nullopt;
    return value;
}

} // namespace

WavelengthGrid parse_bands_option(const std::string& text) {
    const std::vector<std::string_view> parts = split_at_colons(text);
    constexpr const char* remedy = "write FROM:TO:STEP in nm, for instance 380:780:10";
    if (parts.size() != 3)
        throw_input_error({}, fmt::format("--bands '{}' has not three numbers", text), remedy);
    const auto from = number<double>(parts[0]), to = number<double>(parts[1]),
               step = number<double>(parts[2]);
    if (!from || !to || !step)
        throw_input_error({}, fmt::format("--bands '{}' is not made of numbers", text), remedy);
    try {
        return grid_from_range(*from, *to, *step);
    } catch (const std::invalid_argument& error) {
        throw_input_error({}, fmt::format("--bands '{}': {}", text, error.what()), remedy);
    }
}

Model parse_model_option(const std::string& text) {
    try {
        return model_from_name(text);
    } catch (const std::invalid_argument& error) {
        throw_input_error({}, fmt::format("--model: {}", error.what()));
    }
}

WavelengthOptions parse_wavelengths_option(const std::string& text) {
    try {
        return wavelengths_from_text(text);
    } catch (const std::invalid_argument& error) {
        throw_input_error({}, fmt::format("--wavelengths {}", error.what()));
    }
}

SampleRange parse_sample_range_option(const std::string& text) {
    const std::vector<std::string_view> parts = split_at_colons(text);
    const auto first = parts.size() == 2 ? number<std::uint32_t>(parts[0]) : std::nullopt;
    const auto end = parts.size() == 2 ? number<std::uint32_t>(parts[1]) : std::nullopt;
    if (!first || !end || *first >= *end)
        throw_input_error({}, fmt::format("--sample-range '{}' is not a range", text),
                          "write A:B with A < B for the samples A to B - 1");
    return {*first, *end};
}

std::filesystem::path preset_file(const std::string& name) {
    const std::vector<std::string> known = preset_names();
    if (std::find(known.begin(), known.end(), name) == known.end())
        throw_input_error({}, fmt::format("no preset is called '{}'", name),
                          fmt::format("there are: {}", fmt::join(known, ", ")));
    return spectra_directory() / "materials" / (name + ".toml");
}

} // namespace reradiant
