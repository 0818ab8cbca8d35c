#pragma once

#include "host/spectral/text/text_reader.h"
#include "host/spectral/text/words.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reradiant {

/// Lines of a CSV as spreadsheets save them again: filled up with empty cells, in quotation marks
/// as a whole, below a line `sep=,` for the spreadsheet itself.

/// The line without the empty cells behind it and the quotation marks around the rest.
std::string_view without_padding(std::string_view line);
/// Cells of the reader's current line; blanks separate them where nothing else does.
std::vector<TextToken> table_cells(const TextReader& reader, std::string_view line);
/// Drops empty cells beyond the first `most`.
void drop_padding(std::vector<TextToken>& cells, std::size_t most);
/// True for a line that begins with '#'.
bool is_remark(std::string_view line);
/// True for a line of cells: neither a remark nor empty nor `sep=,`.
bool is_line_of_cells(std::string_view line);

/// The line `# key: value` or `# key = value`, with the places of both.
struct HeaderEntry {
    TextToken key, value;
    std::string name; ///< the key in lower case, its words joined by '-'
};
/// Returns the entry of a line; empty for a remark of another form.
std::optional<HeaderEntry> header_entry(const TextReader& reader, std::string_view line);
/// Letters more, less, other or swapped with their neighbour that make one word the other (optimal
/// string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

} // namespace reradiant
