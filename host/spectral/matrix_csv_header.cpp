#include "host/spectral/matrix_csv_header.h"

#include "host/spectral/wavelength_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace reradiant {

namespace {

constexpr std::array known_keys{"quantity",         "orientation",       "kind",
                                "anti-stokes",      "geometry",          "unit",
                                "emission-step-nm", "excitation-step-nm"};

std::string_view first_word(std::string_view text) {
    return text.substr(0, std::min(text.find_first_of(" \t,;("), text.size()));
}

template <typename Value>
void set_once(const TextReader& reader, const TextToken& key, std::optional<Value>& field,
              const Value& value) {
    if (field)
        throw_input_error(reader.position(key), fmt::format("'{}' is given twice", key.text),
                          "keep one of the two lines");
    field = value;
}

double step_value(const TextReader& reader, TextToken value) {
    value.text = first_word(value.text);
    return reader.wavelength_nm(value);
}

/// What a value's unit may be called where it is 1. The unit of the axes says nothing of values.
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
        set_once(reader, entry.key, header.is_percent, false);
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
    set_once(reader, entry.key, header.is_percent, is_percent);
}

void refuse_misspelt(const TextReader& reader, const HeaderEntry& entry) {
    for (const char* key : known_keys)
        if (is_misspelt(entry.name, key))
            throw_input_error(reader.position(entry.key),
                              fmt::format("the key '{}' is not known", entry.key.text),
                              fmt::format("did you mean '{}'?", key));
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
    if (begins_as_number(entry.value.text) &&
        is_one_of(std::array{"factor", "scale", "scale-factor", "scaling", "scaling-factor",
                             "multiplier"},
                  entry.name))
        throw_input_error(reader.position(entry.key),
                          "the line states a factor that is not applied here",
                          "multiply the values by it and leave the line out");
}

void read_csv_header_line(const TextReader& reader, std::string_view line, CsvHeader& header) {
    const std::optional<HeaderEntry> entry = header_entry(reader, line);
    if (!entry)
        return;
    const auto& [key, value, name] = *entry;
    if (name == "quantity")
        set_once(reader, key, header.quantity,
                 is_first_of(reader, value, "per-band", "density-per-nm")
                     ? MatrixQuantity::PerBand
                     : MatrixQuantity::DensityPerNm);
    else if (name == "orientation")
        set_once(reader, key, header.rows_are_emission,
                 is_first_of(reader, value, "rows-emission", "rows-excitation"));
    else if (name == "kind")
        set_once(reader, key, header.kind,
                 is_first_of(reader, value, "model", "measured") ? MatrixKind::Model
                                                                 : MatrixKind::Measured);
    else if (name == "anti-stokes")
        set_once(reader, key, header.anti_stokes_allowed,
                 is_first_of(reader, value, "allowed", "refused"));
    else if (name == "geometry")
        set_once(reader, key, header.geometry, std::string(value.text));
    else if (is_one_of(std::array{"unit", "units", "value-unit", "value-units", "y-units"}, name))
        read_unit(reader, *entry, header);
    else if (name == "emission-step-nm")
        set_once(reader, key, header.emission_step_nm, step_value(reader, value));
    else if (name == "excitation-step-nm")
        set_once(reader, key, header.excitation_step_nm, step_value(reader, value));
    else {
        refuse_factor(reader, *entry);
        refuse_misspelt(reader, *entry);
    }
}

void read_value_unit(const TextReader& reader, const TextToken& heading, CsvHeader& header) {
    if (!names_percent(heading.text))
        return;
    if (header.is_percent && !*header.is_percent)
        throw_input_error(reader.position(heading), "the heading says percent, a '#' line does not",
                          "keep the one that is right");
    header.is_percent = true;
}

void require_declared(const TextReader& reader, const CsvHeader& header) {
    const SourcePosition position = reader.end_position();
    if (!header.quantity)
        throw_input_error(position, "the quantity is not declared",
                          "add the line '# quantity: per-band' or '# quantity: density-per-nm'");
    if (!header.rows_are_emission)
        throw_input_error(
            position, "the orientation is not declared",
            "add the line '# orientation: rows-emission' or '# orientation: rows-excitation'");
}

void require_consistent_unit(const CsvHeader& header) {
    if (header.per_nm_at && header.quantity != MatrixQuantity::DensityPerNm)
        throw_input_error(*header.per_nm_at, "values per nm are no quantity per band",
                          "write '# quantity: density-per-nm'");
}

} // namespace reradiant
