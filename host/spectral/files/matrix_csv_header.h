#pragma once

#include "host/spectral/text/csv_lines.h"
#include "host/spectral/text/text_reader.h"
#include "reradiant/reradiation.h"
#include "reradiant/spectral_files.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reradiant {

/// A `CsvHeader` holds what the '#' lines of a re-radiation CSV say. Quantity and orientation are
/// never guessed.
struct CsvHeader {
    std::optional<MatrixQuantity> quantity;
    std::optional<bool> rows_are_emission;
    std::optional<MatrixKind> kind;
    std::optional<bool> anti_stokes_allowed;
    std::optional<std::string> geometry;
    std::optional<bool> is_percent;
    std::optional<double> factor;            ///< of a line that states one
    std::optional<SourcePosition> per_nm_at; ///< where the unit is said to be 1/nm
    std::optional<double> emission_step_nm, excitation_step_nm; ///< for an axis of one band
    std::map<std::string, SourcePosition> places;               ///< of the keys, by name

    /// Returns the factor that the values are multiplied by.
    double scale() const;
};

/// Takes a '#' line of a re-radiation CSV, the reader's current one. Keys may be in any case, with
/// ':' or '='. Lines of another form are remarks, and so are keys that resemble none. Input Error
/// for a key that is nearly one, or given twice, and for a value that is not known.
void read_csv_header_line(const TextReader& reader, std::string_view line, CsvHeader& header);

/// Input Error for a line such as "quantity: per-band" or "# kind measured", which lacks its '#' or
/// its ':'.
void refuse_lost_key(const TextReader& reader, std::string_view line);

/// Takes what the heading of the first column says of the values: "nm (values in %)".
void read_value_unit(const TextReader& reader, const TextToken& heading, CsvHeader& header);

/// Adds what the reader was told. Input Error at what the file says otherwise.
void add_told(const TextReader& reader, CsvHeader& header, const TableForm& told);

/// Input Error where the unit is 1/nm and the quantity another than density-per-nm, and for a
/// factor that nobody told to apply.
void require_consistent_unit(const CsvHeader& header, const TableForm& told);

/// A `LongRole` is what a column of the long form holds, by its heading: excitation_nm, "Ex (nm)"
/// and so on.
enum class LongRole { None, Excitation, Emission, Value };
LongRole long_role(std::string_view heading);
/// True for the headings excitation_nm,emission_nm,value in any order and of any such spelling.
bool names_long_form(const std::vector<TextToken>& headings);
/// Wavelengths in nm, three at least, that ascend or descend: all cells from one on.
bool are_bands(const std::vector<TextToken>& cells, std::size_t from);
/// A `HeadingKind` is what a line of cells above the first row is. heading_kind returns it, where
/// `next` is the line of cells behind it.
enum class HeadingKind { Title, Headings, HeadingsWithoutCorner, Row };
HeadingKind heading_kind(std::vector<TextToken> cells, std::vector<TextToken> next);
/// The line of cells that the reader will give next; empty where there is none.
std::vector<TextToken> next_cells(const TextReader& reader);

/// Returns whether a word is the first of two in any case; input Error where it is neither.
bool is_first_of(const TextReader& reader, const TextToken& value, std::string_view first,
                 std::string_view second);

/// Input Error for a key of a factor that the values would have to be multiplied by.
void refuse_factor(const TextReader& reader, const HeaderEntry& entry);

} // namespace reradiant
