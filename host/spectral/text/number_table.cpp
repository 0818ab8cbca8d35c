#include "host/spectral/text/number_table.h"

#include "host/spectral/text/head_key.h"
#include "host/spectral/text/table_head.h"
#include "host/spectral/text/text_reader.h"
#include "host/spectral/text/wavelength_unit.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

namespace reradiant {

namespace {

bool is_ascending(const std::vector<double>& values) {
    return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

/// Cells of a row; blanks separate them where nothing else does.
std::vector<TextToken> cells_of(const TextReader& reader, std::string_view line) {
    return line.find_first_of(",;") == std::string_view::npos ? reader.split_at_blanks(line)
                                                              : reader.split_cells(line);
}

bool holds_digit(std::string_view text) {
    return text.find_first_of("0123456789") != std::string_view::npos;
}

/// A number, perhaps with a percent sign or a bracket behind it.
bool is_nearly_number(std::string_view text) {
    while (!text.empty() && std::string_view("%)] ").find(text.back()) != std::string_view::npos)
        text.remove_suffix(1);
    return is_number(text);
}

/// True where a line ends within a quoted cell; the mark in "5\" tile" opens none.
bool is_cell_open(std::string_view line) {
    if (std::count(line.begin(), line.end(), '"') % 2 == 0)
        return false;
    const std::string_view before = trimmed(line.substr(0, line.rfind('"')));
    return before.empty() || std::string_view(",;").find(before.back()) != std::string_view::npos ||
           line[line.rfind('"') - 1] == '\t';
}

/// Cells without the empty ones that spreadsheets fill rows up with.
std::vector<TextToken> without_padding(std::vector<TextToken> cells, std::size_t count) {
    while (cells.size() > count && cells.back().text.empty())
        cells.pop_back();
    return cells;
}

/// "x400,0.5", "l00,50%", ",0.9" are rows that went wrong rather than headings. pandas heads a
/// series by ",0".
bool looks_like_row(const std::vector<TextToken>& padded, std::size_t count) {
    const auto cells = without_padding(padded, count);
    const std::string_view first = cells[0].text;
    if (is_number(first))
        return true;
    if (cells.size() < 2 || !is_nearly_number(cells[1].text))
        return false;
    if (cells.size() != count)
        return first.size() > 1 && is_number(first.substr(1));
    return first.empty() ? cells[1].text != "0" : holds_digit(first);
}

/// Reads the rows of a table whose columns have units.
class RowReader {
public:
    RowReader(const std::filesystem::path& file, int column_count)
        : reader_(file), column_count_(static_cast<std::size_t>(column_count)) {
        table_.file = reader_.name();
        table_.columns.resize(column_count_);
    }

    UnsortedTable read() {
        for (std::string_view line; reader_.next_line(line);) {
            const std::string_view text = trimmed(line);
            if (is_comment(line))
                read_comment(text.substr(1));
            else if (const auto cells = cells_of(reader_, line); !is_empty(cells))
                read_cells(line, cells);
        }
        if (table_.places.empty())
            throw_input_error(reader_.end_position(), "no values",
                              "a spectrum holds at least one line: wavelength in nm, value");
        return std::move(table_);
    }

private:
    static bool is_empty(const std::vector<TextToken>& cells) {
        return std::all_of(cells.begin(), cells.end(),
                           [](const TextToken& cell) { return cell.text.empty(); });
    }

    /// A semicolon marks a comment unless it stands for an empty cell: ";0.9".
    bool is_comment(std::string_view line) const {
        const std::string_view text = trimmed(line);
        if (text.starts_with('#'))
            return true;
        if (!text.starts_with(';'))
            return false;
        const auto cells = reader_.split_cells(line);
        return !is_empty(cells) && !(cells.size() == column_count_ && is_number(cells[1].text));
    }

    void read_cells(std::string_view line, const std::vector<TextToken>& cells) {
        const std::string_view first = cells.front().text;
        // "1/cm" and "1/um" are the headings that begin with a digit.
        const bool is_heading = table_.places.empty() && (first.empty() || !is_gap(first)) &&
                                (!begins_as_number(first) || first.starts_with("1/")) &&
                                !looks_like_row(cells, column_count_);
        if (is_heading || (table_.places.empty() && tells_units(line)))
            return read_heading(line, cells);
        if (table_.places.empty())
            units_ = column_units(head_, line, column_count_, reader_.name());
        table_.unit = units_.source;
        read_row(cells);
    }

    void read_comment(std::string_view text) {
        const auto from = text.find_first_not_of("#; \t");
        if (from == std::string_view::npos)
            return;
        text.remove_prefix(from);
        if (table_.places.empty())
            head_.push_back({std::string(text), reader_.line_number(), true});
        else if (tells_units(text))
            throw_input_error(reader_.position(reader_.line_number(), 1),
                              "the line tells units behind the values they are for",
                              "move it above the values");
    }

    void read_heading(std::string_view line, const std::vector<TextToken>& cells) {
        if (cells.front().text == "theta_i_deg")
            throw_input_error(reader_.position(cells.front()),
                              "this is a measurement of `measure`, not a spectrum",
                              "`reradiant fit` reads it");
        HeadLine heading{std::string(trimmed(line)), reader_.line_number()};
        // A quoted cell may hold line breaks.
        for (std::string_view next; is_cell_open(heading.text) && reader_.next_line(next);)
            heading.text.append(" ").append(trimmed(next));
        head_.push_back(std::move(heading));
    }

    void read_row(const std::vector<TextToken>& padded) {
        const auto cells = without_padding(padded, column_count_);
        if (cells.size() != column_count_)
            throw_input_error(reader_.position(cells[0]),
                              fmt::format("{} values in this line", cells.size()),
                              fmt::format("{} are needed: a wavelength and its value{}",
                                          column_count_, column_count_ > 2 ? "s" : ""));
        table_.columns[0].push_back(wavelength_nm(cells[0]));
        table_.places.push_back({cells[0].line, cells[0].column});
        for (std::size_t column = 1; column < cells.size(); ++column)
            table_.columns[column].push_back(value(cells[column], units_.divisors[column]));
    }

    double wavelength_nm(const TextToken& cell) const {
        const WavelengthUnit& unit = units_.wavelength;
        if (cell.text.ends_with("nm") || (unit.factor == 1.0 && !unit.reciprocal))
            return reader_.wavelength_nm(cell);
        const double given = reader_.number(cell);
        const double nm = given > 0.0 ? unit.to_nm(given) : 0.0;
        if (!(nm > 0.0 && nm <= 1e6))
            throw_input_error(reader_.position(cell),
                              fmt::format("{} {} is not a wavelength of light", given, unit.name),
                              "check the unit that the heading states");
        return nm;
    }

    /// A value with a percent sign of its own needs no heading.
    double value(TextToken cell, double divisor) const {
        if (cell.text.ends_with('%')) {
            cell.text = trimmed(cell.text.substr(0, cell.text.size() - 1));
            divisor = 100.0;
        }
        return reader_.number(cell) / divisor;
    }

    TextReader reader_;
    UnsortedTable table_;
    std::size_t column_count_;
    std::vector<HeadLine> head_; ///< what stands before the first row
    ColumnUnits units_;
};

} // namespace

NumberTable sorted_table(UnsortedTable table) {
    const std::vector<double>& nm = table.columns[0];
    const auto [low, high] = std::minmax_element(nm.begin(), nm.end());
    require_plausible_range(*low, *high, table.unit,
                            {table.file, table.places[0].line, table.places[0].column});
    if (is_ascending(nm))
        return {std::move(table.columns)};
    std::vector<std::size_t> order(nm.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return nm[a] < nm[b]; });
    for (std::size_t k = 1; k < order.size(); ++k)
        if (const auto place = table.places[order[k]]; nm[order[k]] == nm[order[k - 1]])
            throw_input_error({table.file, place.line, place.column},
                              fmt::format("wavelength {} nm is given twice", nm[order[k]]),
                              "give every wavelength once");
    NumberTable sorted;
    for (const std::vector<double>& column : table.columns) {
        sorted.columns.emplace_back();
        for (const std::size_t row : order)
            sorted.columns.back().push_back(column[row]);
    }
    return sorted;
}

NumberTable read_number_table(const std::filesystem::path& file, int column_count) {
    return sorted_table(RowReader(file, column_count).read());
}

} // namespace reradiant
