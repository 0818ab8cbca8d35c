#include "tools/commands/colour/colour_table.h"

#include "host/base/atomic_file.h"

#include <algorithm>
#include <cstdlib>

namespace reradiant {

namespace {

/// Characters, not bytes.
std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

bool is_a_number(const std::string& text) {
    char* end = nullptr;
    std::strtod(text.c_str(), &end);
    return end != text.c_str() && *end == '\0';
}

std::string csv_cell(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char character : text)
        quoted += character == '"' ? std::string("\"\"") : std::string(1, character);
    return quoted + '"';
}

} // namespace

std::string aligned(const ColourTable& table) {
    std::vector<std::size_t> widths;
    for (std::size_t c = 0; c < table.header.size(); ++c) {
        widths.push_back(width(table.header[c]));
        for (const auto& row : table.rows)
            widths.back() = std::max(widths.back(), width(row[c]));
    }
    std::vector<bool> to_the_right;
    for (std::size_t c = 0; c < table.header.size(); ++c)
        to_the_right.push_back(
            std::all_of(table.rows.begin(), table.rows.end(),
                        [c](const auto& row) { return row[c].empty() || is_a_number(row[c]); }));
    std::string text;
    const auto add_line = [&](const std::vector<std::string>& cells) {
        std::string line;
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const std::string blanks(widths[c] - width(cells[c]), ' ');
            line += (c > 0 ? "  " : "") + (to_the_right[c] ? blanks + cells[c] : cells[c] + blanks);
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    };
    add_line(table.header);
    for (const auto& row : table.rows)
        add_line(row);
    return text;
}

void write_csv(const std::filesystem::path& file, const ColourTable& table) {
    std::string text;
    const auto add_line = [&](const std::vector<std::string>& cells) {
        for (std::size_t c = 0; c < cells.size(); ++c)
            text += (c > 0 ? "," : "") + csv_cell(cells[c]);
        text += '\n';
    };
    add_line(table.header);
    for (const auto& row : table.rows)
        add_line(row);
    write_text_atomically(file, text);
}

} // namespace reradiant
