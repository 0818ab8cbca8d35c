#include "host/spectral/text/decimal_comma.h"

#include "host/spectral/text/text_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace reradiant {

namespace {

constexpr auto none = std::string_view::npos;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// A piece of a line and where it begins in the text.
struct Piece {
    std::size_t start = 0;
    std::string_view text;
};

Piece trimmed_piece(std::string_view text, std::size_t from, std::size_t to) {
    std::string_view part = trimmed(text.substr(from, to - from));
    if (part.size() > 1 && part.front() == '"' && part.back() == '"')
        part = trimmed(part.substr(1, part.size() - 2));
    return {part.empty() ? from : static_cast<std::size_t>(part.data() - text.data()), part};
}

/// A number's text without the percent sign or unit behind it.
std::string_view bare(std::string_view cell) {
    for (const std::string_view unit : {"%", "nm"})
        if (cell.ends_with(unit))
            return trimmed(cell.substr(0, cell.size() - unit.size()));
    return cell;
}

/// Place of the comma in a number such as -0,25e-3; `none` for any other text.
std::size_t decimal_comma(std::string_view cell) {
    cell = bare(cell);
    const auto comma = cell.find(',');
    if (comma == none || comma == 0 || comma + 1 >= cell.size() || !is_digit(cell[comma - 1]) ||
        !is_digit(cell[comma + 1]))
        return none;
    std::string with_point(cell);
    with_point[comma] = '.';
    return is_number(with_point) && cell.find('.') == none ? comma : none;
}

bool has_decimal_point(std::string_view cell) {
    return is_number(bare(cell)) && cell.find('.') != none;
}

/// 1,234 and 12,345 may be thousands; 0,123 and 1234,567 may not.
bool may_be_thousands(std::string_view cell) {
    cell = bare(cell);
    if (cell.starts_with('-') || cell.starts_with('+'))
        cell.remove_prefix(1);
    const auto comma = cell.find(',');
    return comma <= 3 && cell.size() == comma + 4 && cell[0] != '0' &&
           std::all_of(cell.begin() + static_cast<std::ptrdiff_t>(comma) + 1, cell.end(), is_digit);
}

/// Pieces of a line between the separators that no quotation marks enclose.
std::vector<Piece> pieces_between(std::string_view text, std::size_t from, std::size_t to,
                                  char separator) {
    std::vector<Piece> pieces;
    bool is_quoted = false;
    std::size_t start = from;
    for (std::size_t k = from; k <= to; ++k) {
        if (k < to && text[k] == '"')
            is_quoted = !is_quoted;
        if (k < to && (is_quoted || text[k] != separator))
            continue;
        pieces.push_back(trimmed_piece(text, start, k));
        start = k + 1;
    }
    return pieces;
}

/// The cells of a line that a comma within them does not separate; nothing where it may.
std::vector<Piece> cells_of_line(std::string_view text, std::size_t from, std::size_t to) {
    const std::string_view line = text.substr(from, to - from);
    for (const char separator : {';', '\t'}) {
        if (line.find(separator) == none)
            continue;
        std::vector<Piece> pieces = pieces_between(text, from, to, separator);
        const auto filled = std::count_if(pieces.begin(), pieces.end(),
                                          [](const Piece& piece) { return !piece.text.empty(); });
        if (filled > 1) // one alone at the end of a line separates nothing
            return pieces;
    }
    if (line.find('"') != none) // then what commas separate holds none but between the marks
        return pieces_between(text, from, to, ',');
    std::vector<Piece> pieces = pieces_between(text, from, to, ' ');
    std::erase_if(pieces, [](const Piece& piece) { return piece.text.empty(); });
    const bool are_numbers = std::all_of(pieces.begin(), pieces.end(), [](const Piece& piece) {
        return is_number(piece.text) || decimal_comma(piece.text) != none;
    });
    return pieces.size() > 1 && are_numbers ? pieces : std::vector<Piece>{};
}

/// `MarkedNumbers` collects what the cells of a table say of their decimal mark.
class MarkedNumbers {
public:
    MarkedNumbers(std::string_view text, const std::string& file) : text_(text), file_(file) {
        for (std::size_t from = 0; from < text_.size();) {
            const std::size_t to = std::min(text_.find('\n', from), text_.size());
            ++line_;
            line_start_ = from;
            const std::string_view line = trimmed(text_.substr(from, to - from));
            if (!line.starts_with('#') && !line.starts_with("\"#"))
                take_line(cells_of_line(text_, from, to), line);
            from = to + 1;
        }
    }

    const std::vector<std::size_t>& commas() const { return commas_; }
    bool is_decisive() const { return decisive_; }
    const std::string& first() const { return first_; }
    const SourcePosition& point_at() const { return point_at_; }
    const std::string& point() const { return point_; }
    const SourcePosition& separating_at() const { return separating_at_; }

private:
    SourcePosition position(std::size_t at) const {
        return {file_, line_, static_cast<int>(at - line_start_) + 1};
    }

    /// A point counts in rows only: titles have versions and dates.
    void take_line(const std::vector<Piece>& cells, std::string_view line) {
        if (cells.empty() && separating_at_.line == 0 && begins_as_number(line) &&
            line.find(',') != none)
            separating_at_ = position(line_start_);
        const bool is_row = !cells.empty() && begins_as_number(cells[0].text);
        for (const Piece& cell : cells) {
            if (const auto comma = decimal_comma(cell.text); comma != none) {
                if (commas_.empty())
                    first_ = cell.text;
                commas_.push_back(cell.start + comma);
                decisive_ = decisive_ || !may_be_thousands(cell.text);
            } else if (is_row && point_.empty() && has_decimal_point(cell.text)) {
                point_ = cell.text;
                point_at_ = position(cell.start);
            }
        }
    }

    std::string_view text_;
    const std::string& file_;
    int line_ = 0;
    std::size_t line_start_ = 0;
    std::vector<std::size_t> commas_;
    bool decisive_ = false;
    std::string first_, point_;
    SourcePosition point_at_, separating_at_;
};

/// Returns whether a table has a comma between two digits and so is worth a look cell by cell: most
/// have none.
bool has_comma_in_digits(std::string_view text) {
    for (auto at = text.find(','); at != none; at = text.find(',', at + 1))
        if (at > 0 && at + 1 < text.size() && is_digit(text[at - 1]) && is_digit(text[at + 1]))
            return true;
    return false;
}

void refuse_contradiction(const MarkedNumbers& numbers) {
    if (!numbers.point().empty())
        throw_input_error(numbers.point_at(),
                          fmt::format("'{}' has a decimal point, where commas are said to be the "
                                      "decimal mark",
                                      numbers.point()),
                          "write all numbers with commas, or say that the mark is the point");
    if (numbers.separating_at().line > 0)
        throw_input_error(numbers.separating_at(),
                          "commas separate the cells and cannot be the decimal mark, too",
                          "save the sheet with semicolons or tabs between its cells");
}

} // namespace

std::string write_decimal_points(std::string& text, DecimalMark mark, const std::string& file) {
    if (mark == DecimalMark::Point ||
        (mark == DecimalMark::Automatic && !has_comma_in_digits(text)))
        return {};
    const MarkedNumbers numbers(text, file);
    if (mark == DecimalMark::Comma)
        refuse_contradiction(numbers);
    else if (numbers.commas().empty())
        return {};
    else if (!numbers.point().empty())
        return fmt::format("'{}' in line {} has a decimal point: write all numbers with one mark",
                           numbers.point(), numbers.point_at().line);
    else if (!numbers.is_decisive())
        return fmt::format("the comma in '{}' may be a decimal mark or part thousands: write "
                           "numbers like 0.25, or of a re-radiation matrix say which by `reradiant "
                           "convert` with --decimal",
                           numbers.first());
    for (const std::size_t comma : numbers.commas())
        text[comma] = '.';
    return {};
}

} // namespace reradiant
