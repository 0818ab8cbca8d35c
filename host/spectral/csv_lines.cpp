#include "host/spectral/csv_lines.h"

#include <algorithm>

namespace reradiant {

std::string_view without_padding(std::string_view line) {
    line = trimmed(line);
    while (!line.empty() && (line.back() == ',' || line.back() == ';'))
        line = trimmed(line.substr(0, line.size() - 1));
    if (line.size() > 1 && line.front() == '"' && line.find('"', 1) == line.size() - 1)
        line = trimmed(line.substr(1, line.size() - 2));
    return line;
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

bool is_misspelt(std::string_view word, std::string_view right) {
    while (!word.empty() && !right.empty() && word.front() == right.front()) {
        word.remove_prefix(1);
        right.remove_prefix(1);
    }
    while (!word.empty() && !right.empty() && word.back() == right.back()) {
        word.remove_suffix(1);
        right.remove_suffix(1);
    }
    const bool swapped =
        word.size() == 2 && right.size() == 2 && word[0] == right[1] && word[1] == right[0];
    return swapped || (word.size() <= 1 && right.size() <= 1 && word.size() + right.size() > 0);
}

} // namespace reradiant
