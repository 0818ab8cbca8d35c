#include "host/spectral/matrix_csv_header.h"

#include "host/spectral/wavelength_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace reradiant {

namespace {

std::string_view first_word(std::string_view text) {
    return text.substr(0, std::min(text.find_first_of(" \t"), text.size()));
}

template <typename Value>
void set_once(const TextReader& reader, const TextToken& key, std::optional<Value>& field,
              const Value& value) {
    if (field)
        throw_input_error(reader.position(key), fmt::format("'{}' is given twice", key.text),
                          "keep one of the two lines");
    field = value;
}

/// One of two words, or an input Error.
bool is_first_of(const TextReader& reader, const TextToken& value, std::string_view first,
                 std::string_view second) {
    const std::string_view word = first_word(value.text);
    if (word != first && word != second)
        throw_input_error(reader.position(value), fmt::format("'{}' is not known here", word),
                          fmt::format("write {} or {}", first, second));
    return word == first;
}

double step_value(const TextReader& reader, TextToken value) {
    value.text = first_word(value.text);
    return reader.wavelength_nm(value);
}

/// Units that no fraction can be in are refused; any other word than percent is a remark.
bool is_percent(const TextReader& reader, const TextToken& value) {
    std::string unit(value.text);
    std::transform(unit.begin(), unit.end(), unit.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char* word : {"count", "cps", "a.u.", "arbitrary", "relative"})
        if (unit.find(word) != std::string::npos)
            throw_input_error(reader.position(value),
                              fmt::format("'{}' is no unit of a re-radiation matrix", value.text),
                              "scale the values to unit 1, where a white reflects 1");
    return states_percent(unit);
}

} // namespace

void read_csv_header_line(const TextReader& reader, std::string_view line, CsvHeader& header) {
    const auto colon = line.find(':');
    if (colon == std::string_view::npos)
        return;
    const auto hash = line.find('#');
    const std::string_view name = trimmed(line.substr(hash + 1, colon - hash - 1));
    const std::string_view rest = trimmed(line.substr(colon + 1));
    const auto column_of = [&](std::string_view part) {
        return part.empty() ? static_cast<int>(colon) + 2
                            : static_cast<int>(part.data() - line.data()) + 1;
    };
    const TextToken key{name, reader.line_number(), column_of(name)};
    const TextToken value{rest, reader.line_number(), column_of(rest)};
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
        set_once(reader, key, header.geometry, std::string(rest));
    else if (name == "unit" || name == "units")
        set_once(reader, key, header.is_percent, is_percent(reader, value));
    else if (name == "emission-step-nm")
        set_once(reader, key, header.emission_step_nm, step_value(reader, value));
    else if (name == "excitation-step-nm")
        set_once(reader, key, header.excitation_step_nm, step_value(reader, value));
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

} // namespace reradiant
