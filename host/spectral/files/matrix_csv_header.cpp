#include "host/spectral/files/matrix_csv_header.h"

#include "host/spectral/text/wavelength_unit.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace reradiant {

namespace {

constexpr std::array known_keys{"quantity",         "orientation",       "kind",
                                "anti-stokes",      "geometry",          "unit",
                                "emission-step-nm", "excitation-step-nm"};
constexpr const char* unapplied_factor = "the line states a factor that is not applied here";

std::string_view first_word(std::string_view text) {
    return text.substr(0, std::min(text.find_first_of(" \t,;("), text.size()));
}

template <typename Value>
void set_once(const TextReader& reader, const HeaderEntry& entry, CsvHeader& header,
              std::optional<Value> CsvHeader::*field, const Value& value) {
    if (header.*field)
        throw_input_error(reader.position(entry.key),
                          fmt::format("'{}' is given twice", entry.key.text),
                          "keep one of the two lines");
    header.*field = value;
    header.places[entry.name] = reader.position(entry.key);
}

double step_value(const TextReader& reader, TextToken value) {
    value.text =
        value.text.substr(0, std::min(value.text.find_first_of(" \t;("), value.text.size()));
    return reader.wavelength_nm(value); // refuses a decimal comma rather than cutting it off
}

/// Returns whether `unit` names a unit of values that is 1. The unit of the axes, nm, says nothing
/// of values and passes too.
bool is_unit_one(const std::string& unit) {
    return is_one_of(std::array{"-", "none", "unity", "unit 1", "fraction", "ratio",
                                "dimensionless", "nm", "w/w"},
                     unit) ||
           first_word(unit) == "1" || unit.find("reflectance") != std::string::npos ||
           unit.find("radiance factor") != std::string::npos;
}

bool names_percent(std::string_view text) {
    return states_percent(text) || lower_case(text).find("per cent") != std::string::npos;
}

void read_unit(const TextReader& reader, const HeaderEntry& entry, CsvHeader& header) {
    const std::string unit = lower_case(entry.value.text);
    const SourcePosition at = reader.position(entry.value);
    if (is_one_of(std::array{"1/nm", "/nm", "nm-1", "nm^-1", "per nm"}, unit)) {
        set_once(reader, entry, header, &CsvHeader::is_percent, false);
        header.per_nm_at = at;
        return;
    }
    for (const char* word : {"count", "cps", "a.u.", "arbitrary", "relative"})
        if (unit.find(word) != std::string::npos)
            throw_input_error(
                at, fmt::format("'{}' is no unit of a re-radiation matrix", entry.value.text),
                "scale the values to unit 1, where a white reflects 1");
    const bool is_percent = names_percent(unit);
    if (!is_percent && !is_unit_one(unit))
        throw_input_error(
            at, fmt::format("the unit '{}' is not known here", entry.value.text),
            "scale the values to unit 1, where a white reflects 1, or write 'percent'");
    set_once(reader, entry, header, &CsvHeader::is_percent, is_percent);
}

/// True where a key is one that is known but for its spelling: joined or parted otherwise, with
/// one of `extra` behind it, in the plural, or with a few letters wrong for its length.
bool is_nearly(const std::string& name, std::string_view key) {
    const auto joined = [](std::string_view text) {
        std::string letters(text);
        std::erase(letters, '-');
        return letters;
    };
    std::string word = joined(name);
    for (const std::string_view extra : {"allowed", "emission", "nm", "form", "s"})
        if (word.size() > extra.size() + 3 && word.ends_with(extra) &&
            edit_distance(word.substr(0, word.size() - extra.size()), joined(key)) <= 1)
            return true;
    const std::string right = joined(key);
    return edit_distance(word, right) <= (right.size() < 6 ? 1 : 2);
}

void refuse_misspelt(const TextReader& reader, const HeaderEntry& entry) {
    // Plain words of remarks that are near to a key.
    if (is_one_of(std::array{"find", "mind", "wind", "king", "kin", "uni", "quality", "geometric"},
                  entry.name))
        return;
    const auto refuse = [&](const char* right) {
        throw_input_error(reader.position(entry.key),
                          fmt::format("the key '{}' is not known", entry.key.text),
                          fmt::format("write '# {}'", right));
    };
    // The words that options have for the same.
    const std::string value = lower_case(entry.value.text);
    if (entry.name == "rows" && (value == "emission" || value == "excitation"))
        refuse(("orientation: rows-" + value).c_str());
    if (is_one_of(std::array{"scale", "values"}, entry.name) && names_percent(value))
        refuse("unit: percent");
    if (entry.name == "decimal" && (value == "comma" || value == "point"))
        throw_input_error(reader.position(entry.key), "the key 'decimal' is not known",
                          fmt::format("leave the line out and convert with --decimal {}", value));
    for (const char* key : known_keys)
        if (is_nearly(entry.name, key))
            throw_input_error(reader.position(entry.key),
                              fmt::format("the key '{}' is not known", entry.key.text),
                              fmt::format("did you mean '{}'?", key));
}

/// Returns the place where the file says what its values are multiplied by; empty where it does
/// not.
std::optional<SourcePosition> unit_place(const CsvHeader& header) {
    for (const char* key : {"factor", "scale", "scale-factor", "scaling", "scaling-factor",
                            "multiplier", "unit", "units", "value-unit", "value-units", "y-units"})
        if (const auto found = header.places.find(key); found != header.places.end())
            return found->second;
    return std::nullopt;
}

/// Input Error at a line of the file that says other than what the reader was told.
template <typename Value>
void agree(const CsvHeader& header, const char* key, std::optional<Value> CsvHeader::*field,
           const std::optional<Value>& told) {
    if (!told || !(header.*field) || *(header.*field) == *told)
        return;
    throw_input_error(header.places.at(key),
                      fmt::format("the file's '{}' contradicts what was said besides it", key),
                      "leave one of the two out");
}

bool is_factor(const HeaderEntry& entry) {
    return begins_as_number(entry.value.text) &&
           is_one_of(std::array{"factor", "scale", "scale-factor", "scaling", "scaling-factor",
                                "multiplier"},
                     entry.name);
}

} // namespace

bool is_first_of(const TextReader& reader, const TextToken& value, std::string_view first,
                 std::string_view second) {
    const std::string word = lower_case(first_word(value.text));
    if (word != first && word != second)
        throw_input_error(reader.position(value),
                          fmt::format("'{}' is not known here", first_word(value.text)),
                          fmt::format("write {} or {}", first, second));
    return word == first;
}

void refuse_factor(const TextReader& reader, const HeaderEntry& entry) {
    if (is_factor(entry))
        throw_input_error(reader.position(entry.key), unapplied_factor,
                          "multiply the values by it and leave the line out");
}

double CsvHeader::scale() const {
    return factor.value_or(1.0) * (is_percent.value_or(false) ? 0.01 : 1.0);
}

void refuse_lost_key(const TextReader& reader, std::string_view line) {
    constexpr std::array values{"per-band", "density-per-nm", "rows-emission", "rows-excitation",
                                "model",    "measured",       "allowed",       "percent"};
    std::vector<std::string> words;
    constexpr std::string_view marks = "#:=";
    for (const TextToken& word : reader.split_at_blanks(line))
        if (const auto from = word.text.find_first_not_of(marks); from != std::string_view::npos)
            words.push_back(
                lower_case(word.text.substr(from, word.text.find_last_not_of(marks) + 1 - from)));
    if (words.size() == 2 && is_one_of(known_keys, words[0]) && is_one_of(values, words[1]))
        throw_input_error(reader.position(reader.line_number(), 1),
                          "the line is none that declares something",
                          fmt::format("write '# {}: {}'", words[0], words[1]));
}

void read_csv_header_line(const TextReader& reader, std::string_view line, CsvHeader& header) {
    const std::optional<HeaderEntry> entry = header_entry(reader, line);
    if (!entry)
        return refuse_lost_key(reader, line);
    const auto& [key, value, name] = *entry;
    if (name == "quantity")
        set_once(reader, *entry, header, &CsvHeader::quantity,
                 is_first_of(reader, value, "per-band", "density-per-nm")
                     ? MatrixQuantity::PerBand
                     : MatrixQuantity::DensityPerNm);
    else if (name == "orientation")
        set_once(reader, *entry, header, &CsvHeader::rows_are_emission,
                 is_first_of(reader, value, "rows-emission", "rows-excitation"));
    else if (name == "kind")
        set_once(reader, *entry, header, &CsvHeader::kind,
                 is_first_of(reader, value, "model", "measured") ? MatrixKind::Model
                                                                 : MatrixKind::Measured);
    else if (name == "anti-stokes")
        set_once(reader, *entry, header, &CsvHeader::anti_stokes_allowed,
                 is_first_of(reader, value, "allowed", "refused"));
    else if (name == "geometry")
        set_once(reader, *entry, header, &CsvHeader::geometry, std::string(value.text));
    else if (is_one_of(std::array{"unit", "units", "value-unit", "value-units", "y-units"}, name))
        read_unit(reader, *entry, header);
    else if (name == "emission-step-nm")
        set_once(reader, *entry, header, &CsvHeader::emission_step_nm, step_value(reader, value));
    else if (name == "excitation-step-nm")
        set_once(reader, *entry, header, &CsvHeader::excitation_step_nm, step_value(reader, value));
    else if (is_factor(*entry))
        set_once(reader, *entry, header, &CsvHeader::factor, reader.number(value));
    else
        refuse_misspelt(reader, *entry);
}

void read_value_unit(const TextReader& reader, const TextToken& heading, CsvHeader& header) {
    if (!names_percent(heading.text))
        return;
    if (header.is_percent && !*header.is_percent)
        throw_input_error(reader.position(heading), "the heading says percent, a '#' line does not",
                          "keep the one that is right");
    header.is_percent = true;
}

void add_told(const TextReader& reader, CsvHeader& header, const TableForm& told) {
    agree(header, "quantity", &CsvHeader::quantity, told.quantity);
    agree(header, "orientation", &CsvHeader::rows_are_emission, told.rows_are_emission);
    agree(header, "kind", &CsvHeader::kind, told.kind);
    agree(header, "geometry", &CsvHeader::geometry, told.geometry);
    if (told.anti_stokes_allowed)
        agree(header, "anti-stokes", &CsvHeader::anti_stokes_allowed, std::optional(true));
    if (told.scale && (header.is_percent || header.factor) && header.scale() != *told.scale)
        throw_input_error(
            unit_place(header).value_or(reader.end_position()),
            fmt::format("the file scales its values by {:g}, what was said besides it does by {:g}",
                        header.scale(), *told.scale),
            "leave one of the two out");
    if (told.quantity)
        header.quantity = told.quantity;
    if (told.rows_are_emission)
        header.rows_are_emission = told.rows_are_emission;
    if (told.kind)
        header.kind = told.kind;
    if (told.geometry)
        header.geometry = told.geometry;
    if (told.anti_stokes_allowed)
        header.anti_stokes_allowed = true;
}

void require_consistent_unit(const CsvHeader& header, const TableForm& told) {
    if (header.per_nm_at && header.quantity != MatrixQuantity::DensityPerNm)
        throw_input_error(*header.per_nm_at, "values per nm are no quantity per band",
                          "write '# quantity: density-per-nm'");
    if (header.factor && !told.scale)
        throw_input_error(
            *unit_place(header), unapplied_factor,
            fmt::format("multiply the values by it and leave the line out, or convert "
                        "the file with --scale {:g}",
                        *header.factor));
}

} // namespace reradiant
