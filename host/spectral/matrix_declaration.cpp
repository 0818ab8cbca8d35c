#include "host/spectral/csv_lines.h"
#include "host/spectral/matrix_csv_header.h"
#include "host/spectral/matrix_formats.h"

#include <algorithm>

namespace reradiant {

bool names_long_form(const std::vector<TextToken>& headings) {
    return std::any_of(headings.begin(), headings.end(), [](const TextToken& heading) {
        const std::string name = lower_case(heading.text);
        return name == "excitation_nm" || name == "emission_nm";
    });
}

bool is_title(const std::vector<TextToken>& cells) {
    return !begins_as_number(cells[0].text) && !names_long_form(cells) &&
           (cells.size() < 2 || !begins_as_number(cells[1].text));
}

std::optional<SourcePosition> declares_reradiation(const std::filesystem::path& file) {
    TextReader reader(file);
    std::optional<SourcePosition> mentioned;
    for (std::string_view line; reader.next_line(line);) {
        const std::string_view text = without_padding(line);
        if (text.starts_with('#') && lower_case(trimmed(text.substr(1))) == "reradiation")
            return reader.position(reader.line_number(), 1);
        if (const auto entry = header_entry(reader, line);
            entry && (entry->name == "quantity" || entry->name == "orientation")) {
            mentioned = mentioned.value_or(reader.position(entry->key));
            const std::string value = lower_case(entry->value.text);
            if (value.starts_with("rows-") || value.starts_with("per-band") ||
                value.starts_with("density-per-nm"))
                return mentioned;
        }
        if (!is_line_of_cells(line))
            continue;
        const std::vector<TextToken> cells = reader.split_cells(line);
        if (names_long_form(cells))
            return reader.position(cells[0]);
        if (begins_as_number(cells[0].text))
            return std::nullopt; // the first row of a spectrum
        if (!is_title(cells))
            return mentioned;
    }
    return std::nullopt;
}

} // namespace reradiant
