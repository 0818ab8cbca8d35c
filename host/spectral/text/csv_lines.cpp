#include "host/spectral/text/csv_lines.h"

#include <algorithm>
#include <utility>

namespace reradiant {

std::string_view without_padding(std::string_view line) {
    line = trimmed(line);
    while (!line.empty() && (line.back() == ',' || line.back() == ';'))
        line = trimmed(line.substr(0, line.size() - 1));
    if (line.size() > 1 && line.front() == '"' && line.find('"', 1) == line.size() - 1)
        line = trimmed(line.substr(1, line.size() - 2));
    return line;
}

std::vector<TextToken> table_cells(const TextReader& reader, std::string_view line) {
    return line.find_first_of(",;\t") == std::string_view::npos ? reader.split_at_blanks(line)
                                                                : reader.split_cells(line);
}

void drop_padding(std::vector<TextToken>& cells, std::size_t most) {
    while (cells.size() > most && cells.back().text.empty())
        cells.pop_back();
}

bool is_remark(std::string_view line) {
    return without_padding(line).starts_with('#');
}

bool is_line_of_cells(std::string_view line) {
    const std::string_view text = without_padding(line);
    const bool is_for_spreadsheets =
        lower_case(text.substr(0, 4)) == "sep=" && trimmed(line).size() <= 5;
    return !text.empty() && !text.starts_with('#') && !is_for_spreadsheets;
}

std::optional<HeaderEntry> header_entry(const TextReader& reader, std::string_view line) {
    std::string_view text = without_padding(line);
    if (!text.starts_with('#'))
        return std::nullopt;
    text.remove_prefix(std::min(text.find_first_not_of('#'), text.size()));
    const auto sign = text.find_first_of(":=");
    if (sign == std::string_view::npos)
        return std::nullopt;
    const std::string_view key = trimmed(text.substr(0, sign)),
                           value = trimmed(text.substr(sign + 1));
    const auto token = [&](std::string_view part, const char* otherwise) {
        const char* const at = part.empty() ? otherwise : part.data();
        return TextToken{part, reader.line_number(), static_cast<int>(at - line.data()) + 1};
    };
    HeaderEntry entry{token(key, text.data()), token(value, text.data() + sign + 1),
                      lower_case(key)};
    std::replace_if(
        entry.name.begin(), entry.name.end(), [](char c) { return c == ' ' || c == '_'; }, '-');
    return entry;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // Row i of the table holds the distances of a's first i letters to the beginnings of b.
    std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
    for (std::size_t k = 0; k <= b.size(); ++k)
        last[k] = k;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t k = 1; k <= b.size(); ++k) {
            const std::size_t other = a[i - 1] == b[k - 1] ? 0 : 1;
            row[k] = std::min({last[k] + 1, row[k - 1] + 1, last[k - 1] + other});
            if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
                row[k] = std::min(row[k], before_last[k - 2] + 1);
        }
        before_last = std::exchange(last, row);
    }
    return last[b.size()];
}

} // namespace reradiant
