#include "host/spectral/text_reader.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>
#include <utility>

namespace reradiant {

namespace {

constexpr std::uintmax_t most_bytes = 64u << 20;
constexpr double largest_magnitude = 1e30;
constexpr double largest_wavelength_nm = 1e6;

/// from_chars takes no leading plus.
std::string_view without_plus(std::string_view text) {
    return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

bool parse(std::string_view text, double& value) {
    text = without_plus(text);
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return !text.empty() && error == std::errc() && stop == end;
}

std::string shortened(std::string_view text) {
    return text.size() <= 40 ? std::string(text) : std::string(text.substr(0, 37)) + "...";
}

} // namespace

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r\f\v");
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(" \t\r\f\v") - first + 1);
}

bool is_number(std::string_view text) {
    double ignored = 0.0;
    return parse(text, ignored);
}

TextReader::TextReader(const std::filesystem::path& file) : name_(file.string()) {
    std::error_code code;
    const auto size = std::filesystem::file_size(file, code);
    if (code)
        throw_input_error({name_}, fmt::format("cannot be read: {}", code.message()),
                          "name an existing file");
    if (size > most_bytes)
        throw_input_error({name_}, fmt::format("{} bytes are too many", size),
                          fmt::format("at most {} are read", most_bytes));
    std::ifstream stream(file, std::ios::binary);
    content_.resize(static_cast<std::size_t>(size));
    if (!stream.read(content_.data(), static_cast<std::streamsize>(size)))
        throw_input_error({name_}, "cannot be read", "check its permissions");
    if (content_.starts_with("\xef\xbb\xbf"))
        next_ = 3;
}

bool TextReader::next_line(std::string_view& line) {
    if (next_ >= content_.size())
        return false;
    const auto end = std::min(content_.find('\n', next_), content_.size());
    line = std::string_view(content_).substr(next_, end - next_);
    if (line.ends_with('\r'))
        line.remove_suffix(1);
    next_ = end + 1;
    ++line_;
    return true;
}

SourcePosition TextReader::position(const TextToken& token) const {
    return {name_, token.line, token.column};
}

std::vector<TextToken> TextReader::split_at_commas(std::string_view line) const {
    std::vector<TextToken> tokens;
    for (std::size_t start = 0; start <= line.size();) {
        const auto end = std::min(line.find(',', start), line.size());
        const std::string_view piece = line.substr(start, end - start);
        const auto blanks = std::min(piece.find_first_not_of(" \t"), piece.size());
        tokens.push_back({trimmed(piece), line_, static_cast<int>(start + blanks) + 1});
        start = end + 1;
    }
    return tokens;
}

std::vector<TextToken> TextReader::split_at_blanks(std::string_view line) const {
    constexpr std::string_view separators = " \t\r\f\v,;";
    std::vector<TextToken> tokens;
    for (std::size_t start = line.find_first_not_of(separators); start != std::string_view::npos;) {
        const auto end = std::min(line.find_first_of(separators, start), line.size());
        tokens.push_back({line.substr(start, end - start), line_, static_cast<int>(start) + 1});
        start = line.find_first_not_of(separators, end);
    }
    return tokens;
}

double TextReader::number(const TextToken& token) const {
    double value = 0.0;
    if (!parse(token.text, value))
        throw_input_error(position(token),
                          fmt::format("'{}' is not a number", shortened(token.text)),
                          "write it like 0.25 or 2.5e-1");
    if (!(std::abs(value) <= largest_magnitude))
        throw_input_error(position(token),
                          fmt::format("'{}' is not a finite number of magnitude up to {:g}",
                                      shortened(token.text), largest_magnitude),
                          "check the unit");
    return value;
}

double TextReader::wavelength_nm(const TextToken& token) const {
    const double value = number(token);
    if (!(value > 0.0 && value <= largest_wavelength_nm))
        throw_input_error(position(token), fmt::format("{} nm is not a wavelength", value),
                          "wavelengths are in nm and above 0");
    return value;
}

NumberTable read_number_table(const std::filesystem::path& file, int column_count) {
    TextReader reader(file);
    NumberTable table;
    table.columns.resize(static_cast<std::size_t>(column_count));
    bool may_be_heading = true;
    for (std::string_view line; reader.next_line(line);) {
        const std::vector<TextToken> tokens = reader.split_at_blanks(line);
        if (tokens.empty() || tokens[0].text.starts_with('#'))
            continue;
        if (std::exchange(may_be_heading, false) && !is_number(tokens[0].text))
            continue;
        if (tokens.size() != table.columns.size())
            throw_input_error(reader.position(tokens[0]),
                              fmt::format("{} values in this line", tokens.size()),
                              fmt::format("{} are needed: a wavelength and its value{}",
                                          column_count, column_count > 2 ? "s" : ""));
        const double wavelength_nm = reader.wavelength_nm(tokens[0]);
        if (!table.columns[0].empty() && wavelength_nm <= table.columns[0].back())
            throw_input_error(reader.position(tokens[0]),
                              fmt::format("wavelength {} nm does not ascend", wavelength_nm),
                              "sort the lines and give every wavelength once");
        table.columns[0].push_back(wavelength_nm);
        table.first_column_places.push_back({{}, tokens[0].line, tokens[0].column});
        for (std::size_t column = 1; column < tokens.size(); ++column)
            table.columns[column].push_back(reader.number(tokens[column]));
    }
    if (table.columns[0].empty())
        throw_input_error(reader.position(std::max(1, reader.line_number()), 0), "no values",
                          "a spectrum holds at least one line: wavelength in nm, value");
    return table;
}

} // namespace reradiant
