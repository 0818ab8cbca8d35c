#include "host/spectral/text/head_key.h"

#include "host/spectral/text/text_reader.h"
#include "host/spectral/text/words.h"

#include <algorithm>
#include <array>
#include <vector>

namespace reradiant {

namespace {

constexpr std::array<std::string_view, 5> unit_words{"unit", "units", "xunits", "yunits",
                                                     "einheit"};
constexpr std::array<std::string_view, 6> x_axes{"x",      "wavelength", "wavelengths",
                                                 "lambda", "abscissa",   "xunits"};
constexpr std::array<std::string_view, 13> y_axes{
    "y",         "value", "values",      "ordinate", "reflectance", "transmittance", "yunits",
    "intensity", "data",  "measurement", "spectral", "photometric", "reflectivity"};
constexpr std::array<std::string_view, 12> factors{
    "factor",      "scale",   "scaling", "multiplier", "yfactor",    "xfactor",
    "scalefactor", "divisor", "divided", "scaled",     "multiplied", "multiply"};
constexpr std::array<std::string_view, 16> companions{
    "x",           "y",          "by",        "value",        "values",      "data",
    "the",         "conversion", "ordinate",  "correction",   "calibration", "axis",
    "reflectance", "spectral",   "intensity", "transmittance"};

/// Words between blanks, brackets, hyphens and underscores.
std::vector<std::string> words_of(std::string_view text) {
    constexpr std::string_view separators = " \t()_-";
    std::vector<std::string> words;
    for (auto from = text.find_first_not_of(separators); from != std::string_view::npos;) {
        const auto to = std::min(text.find_first_of(separators, from), text.size());
        words.emplace_back(text.substr(from, to - from));
        from = text.find_first_not_of(separators, to);
    }
    return words;
}

KeyValue::Kind kind_of_key(std::string_view key) {
    const std::vector<std::string> words = words_of(lower_case(key));
    if (words.empty())
        return KeyValue::Kind::None;
    const auto is_unit = [&](const std::string& word) { return is_one_of(unit_words, word); };
    if (words.size() <= 3 && std::any_of(words.begin(), words.end(), is_unit)) {
        if (words.size() == 1 && !words[0].starts_with('x') && !words[0].starts_with('y'))
            return KeyValue::Kind::Units;
        return is_one_of(x_axes, words[0])   ? KeyValue::Kind::XUnits
               : is_one_of(y_axes, words[0]) ? KeyValue::Kind::YUnits
                                             : KeyValue::Kind::None;
    }
    bool has_factor = false;
    for (const std::string& word : words) {
        has_factor = has_factor || is_one_of(factors, word);
        if (!is_one_of(factors, word) && !is_one_of(companions, word))
            return KeyValue::Kind::None;
    }
    return has_factor ? KeyValue::Kind::Factor : KeyValue::Kind::None;
}

} // namespace

KeyValue key_value_of(std::string_view line) {
    std::string text(line);
    std::erase(text, '"');
    const std::string_view whole = trimmed(text);
    auto end = whole.find_first_of(":=,;\t");
    if (end == std::string_view::npos)
        end = whole.find_last_of(' '); // "Scale factor 0.01"
    if (end == std::string_view::npos)
        return {};
    std::string_view value = whole.substr(end);
    while (!value.empty() &&
           std::string_view(":=,; \t").find(value.front()) != std::string_view::npos)
        value.remove_prefix(1);
    while (!value.empty() && std::string_view(",; \t").find(value.back()) != std::string_view::npos)
        value.remove_suffix(1);
    KeyValue found{kind_of_key(whole.substr(0, end)), std::string(value)};
    const bool is_number_or_log = begins_as_number(value) || lower_case(value).starts_with("log");
    if (value.empty() || (found.kind == KeyValue::Kind::Factor && !is_number_or_log))
        found.kind = KeyValue::Kind::None;
    return found;
}

bool tells_units(std::string_view line) {
    return key_value_of(line).kind != KeyValue::Kind::None;
}

bool says_values_are_percent(std::string_view remark) {
    const std::string text = lower_case(remark);
    for (const char* values : {"values", "value", "reflectance", "transmittance", "data"})
        for (const char* link : {" in ", " are ", " are in ", ": ", " (", " [", " (in "})
            for (const char* percent : {"percent", "%", "per cent"})
                if (text.find(std::string(values) + link + percent) != std::string::npos)
                    return true;
    return false;
}

} // namespace reradiant
