#pragma once

#include "host/spectral/csv_lines.h"
#include "host/spectral/reradiation.h"
#include "host/spectral/text_reader.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reradiant {

/// What the '#' lines say. Quantity and orientation are never guessed.
struct CsvHeader {
    std::optional<MatrixQuantity> quantity;
    std::optional<bool> rows_are_emission;
    std::optional<MatrixKind> kind;
    std::optional<bool> anti_stokes_allowed;
    std::optional<std::string> geometry;
    std::optional<bool> is_percent;
    std::optional<SourcePosition> per_nm_at; ///< where the unit is said to be 1/nm
    std::optional<double> emission_step_nm, excitation_step_nm; ///< for an axis of one band
};

/// Takes a '#' line of a re-radiation CSV, the reader's current one. Keys may be in any case, with
/// ':' or '='. Lines of another form are remarks, and so are unknown keys. Input Error for a key
/// that is misspelt by a letter or given twice, a value that is not known, and a factor.
void read_csv_header_line(const TextReader& reader, std::string_view line, CsvHeader& header);

/// Takes what the heading of the first column says of the values: "nm (values in %)".
void read_value_unit(const TextReader& reader, const TextToken& heading, CsvHeader& header);

/// Input Error unless quantity and orientation were declared.
void require_declared(const TextReader& reader, const CsvHeader& header);

/// Input Error where the unit is 1/nm and the quantity another than density-per-nm.
void require_consistent_unit(const CsvHeader& header);

/// True for the headings excitation_nm,emission_nm,value in any order.
bool names_long_form(const std::vector<TextToken>& headings);
/// True for a line above the declarations that names no wavelengths.
bool is_title(const std::vector<TextToken>& cells);

/// Whether a word is the first of two in any case; input Error where it is neither.
bool is_first_of(const TextReader& reader, const TextToken& value, std::string_view first,
                 std::string_view second);

/// Input Error for a key of a factor that the values would have to be multiplied by.
void refuse_factor(const TextReader& reader, const HeaderEntry& entry);

} // namespace reradiant
