#include "host/spectral/text/text_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

namespace reradiant {

namespace {

constexpr double largest_magnitude = 1e30;
constexpr double largest_wavelength_nm = 1e6;
constexpr std::string_view blanks = " \t\r\f\v";
/// These words stand for a value that is missing, as pandas, R, spreadsheets, numpy's masked arrays
/// and instruments write it.
constexpr std::array<std::string_view, 20> gap_words{
    "",     "nan", "+nan", "-nan", "na",  "n/a", "#n/a",    "#na",    "<na>", "null",
    "none", "nil", "-",    "--",   "---", ".",   "missing", "masked", "nd",   "n.d."};

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

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

std::string_view unquoted(std::string_view text) {
    if (text.size() < 2 || text.front() != '"' || text.back() != '"')
        return text;
    return trimmed(text.substr(1, text.size() - 2));
}

/// End of the piece that begins at `start`: the next separator that no quotation marks enclose.
std::size_t end_of_piece(std::string_view line, std::size_t start, std::string_view separators) {
    const auto first = line.find_first_not_of(" \t", start);
    if (first < line.size() && line[first] == '"')
        if (const auto close = line.find('"', first + 1); close != std::string_view::npos)
            return std::min(line.find_first_of(separators, close), line.size());
    return std::min(line.find_first_of(separators, start), line.size());
}

/// The separator of a line's cells; where there is none the line is one cell.
std::string_view separator_of(std::string_view line) {
    for (const std::string_view separator : {";", ",", "\t"})
        if (end_of_piece(line, 0, separator) < line.size())
            return separator;
    return ",";
}

} // namespace

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool is_number(std::string_view text) {
    double ignored = 0.0;
    return parse(text, ignored);
}

bool begins_as_number(std::string_view text) {
    if (text.starts_with('+') || text.starts_with('-'))
        text.remove_prefix(1);
    if (text.starts_with('.') || text.starts_with(','))
        text.remove_prefix(1);
    return !text.empty() && is_digit(text.front());
}

bool is_gap(std::string_view text) {
    std::string lower(text.substr(0, 16));
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::find(gap_words.begin(), gap_words.end(), lower) != gap_words.end();
}

TextReader::TextReader(const std::filesystem::path& file, TextFormat expected, DecimalMark decimal)
    : name_(file.string()), content_(read_text_file(file)) {
    const TextFormat format = text_format(content_);
    if (format == expected) {
        if (format == TextFormat::Table || format == TextFormat::Bfc)
            decimal_doubt_ = write_decimal_points(content_, decimal, name_);
        return;
    }
    const bool is_spectrum =
        format == TextFormat::JcampDx || format == TextFormat::Cgats || format == TextFormat::Tm27;
    const char* const remedy = is_spectrum                 ? "give it where a spectrum is asked for"
                               : format == TextFormat::Bfc ? "name it .bfc"
                               : format == TextFormat::Table ? "name it .csv"
                                                             : "save the numbers as CSV";
    throw_input_error(
        {name_, 1, 1},
        fmt::format("the file is {}, not {}", text_format_name(format), text_format_name(expected)),
        remedy);
}

bool TextReader::peek_line(std::string_view& line) const {
    if (next_ >= content_.size())
        return false;
    const auto end = std::min(content_.find('\n', next_), content_.size());
    line = std::string_view(content_).substr(next_, end - next_);
    return true;
}

bool TextReader::next_line(std::string_view& line) {
    if (!peek_line(line))
        return false;
    next_ += line.size() + 1;
    ++line_;
    return true;
}

SourcePosition TextReader::position(const TextToken& token) const {
    return {name_, token.line, token.column};
}

std::vector<TextToken> TextReader::split_cells(std::string_view line) const {
    const std::string_view separator = separator_of(line);
    std::vector<TextToken> tokens;
    for (std::size_t start = 0; start <= line.size();) {
        const auto end = end_of_piece(line, start, separator);
        const std::string_view piece = line.substr(start, end - start);
        const std::string_view text = unquoted(trimmed(piece));
        const auto column =
            text.empty() ? static_cast<std::ptrdiff_t>(start) : text.data() - line.data();
        tokens.push_back({text, line_, static_cast<int>(column) + 1});
        start = end + 1;
    }
    return tokens;
}

std::vector<TextToken> TextReader::split_at_blanks(std::string_view line) const {
    constexpr std::string_view separators = " \t\r\f\v,;";
    std::vector<TextToken> tokens;
    for (std::size_t start = line.find_first_not_of(separators); start != std::string_view::npos;) {
        const auto end = end_of_piece(line, start, separators);
        const std::string_view piece = line.substr(start, end - start);
        tokens.push_back({unquoted(piece), line_, static_cast<int>(start) + 1});
        start = line.find_first_not_of(separators, end);
    }
    return tokens;
}

double TextReader::number(const TextToken& token) const {
    return number_at(token.text, position(token), decimal_doubt_);
}

double TextReader::wavelength_nm(const TextToken& token) const {
    return wavelength_nm_at(token.text, position(token), decimal_doubt_);
}

double number_at(std::string_view text, const SourcePosition& at, const std::string& comma_remedy) {
    if (is_gap(text))
        throw_input_error(at,
                          text.empty() ? std::string("a value is missing")
                                       : fmt::format("'{}' says that a value is missing", text),
                          "give the value; only measured data that are fitted may have gaps, which "
                          "`reradiant fit` fills");
    double value = 0.0;
    if (!parse(text, value))
        throw_input_error(at, fmt::format("'{}' is not a number", shortened(text)),
                          text.find(',') == std::string_view::npos ? "write it like 0.25 or 2.5e-1"
                          : !comma_remedy.empty()
                              ? comma_remedy
                              : "write a decimal point and no thousands separators, as in 0.25");
    if (!(std::abs(value) <= largest_magnitude))
        throw_input_error(at,
                          fmt::format("'{}' is not a finite number of magnitude up to {:g}",
                                      shortened(text), largest_magnitude),
                          "check the unit");
    return value;
}

double wavelength_nm_at(std::string_view text, const SourcePosition& at,
                        const std::string& comma_remedy) {
    if (begins_as_number(text) && text.ends_with("nm"))
        text = trimmed(text.substr(0, text.size() - 2));
    const double value = number_at(text, at, comma_remedy);
    if (!(value > 0.0 && value <= largest_wavelength_nm))
        throw_input_error(at, fmt::format("{} nm is not a wavelength", value),
                          "wavelengths are in nm and above 0");
    return value;
}

} // namespace reradiant
