#include "host/spectral/number_table.h"

#include "host/spectral/text_reader.h"
#include "host/spectral/wavelength_unit.h"

#include <fmt/format.h>

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

/// Headings of a line, where a unit in brackets or behind a stroke belongs to the word before it.
std::vector<std::string> headings_of(const TextReader& reader, std::string_view line) {
    if (line.find_first_of(",;\t") != std::string_view::npos) {
        std::vector<std::string> headings;
        for (const TextToken& cell : reader.split_cells(line))
            headings.emplace_back(cell.text);
        return headings;
    }
    std::vector<std::string> headings;
    bool continues = false;
    for (const TextToken& word : reader.split_at_blanks(line)) {
        const bool joins = continues || word.text.find_first_of("([/") == 0;
        continues = word.text == "/";
        if (joins && !headings.empty())
            headings.back().append(" ").append(word.text);
        else
            headings.emplace_back(word.text);
    }
    return headings;
}

bool holds_digit(std::string_view text) {
    return text.find_first_of("0123456789") != std::string_view::npos;
}

/// Reads the rows of a table whose columns have units.
class RowReader {
public:
    RowReader(const std::filesystem::path& file, int column_count)
        : reader_(file), divisors_(static_cast<std::size_t>(column_count), 1.0) {
        table_.file = reader_.name();
        table_.columns.resize(divisors_.size());
    }

    UnsortedTable read() {
        for (std::string_view line; reader_.next_line(line);) {
            const std::string_view text = trimmed(line);
            if (text.starts_with('#') || text.starts_with(';'))
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

    void read_cells(std::string_view line, const std::vector<TextToken>& cells) {
        const std::string_view first = cells.front().text;
        // "1/cm" is the one heading that begins with a digit.
        const bool is_heading = table_.places.empty() && (first.empty() || !is_gap(first)) &&
                                (!begins_as_number(first) || first == "1/cm");
        is_heading ? read_heading(line, cells) : read_row(cells);
    }

    /// "# nm value", as numpy writes headings and this program .spd files.
    void read_comment(std::string_view text) {
        const auto headings = headings_of(reader_, text);
        if (table_.places.empty() && headings.size() == divisors_.size() && headings[0] != "A" &&
            headings[0] != "m" && names_wavelengths(headings[0]))
            take_units(headings);
    }

    void read_heading(std::string_view line, const std::vector<TextToken>& cells) {
        const auto headings = headings_of(reader_, line);
        if (cells.front().text == "theta_i_deg")
            throw_input_error(reader_.position(cells.front()),
                              "this is a measurement of `measure`, not a spectrum",
                              "`reradiant fit` reads it");
        if (cells.size() > 1 && is_number(cells.back().text)) {
            if (line.find("actor") != std::string_view::npos ||
                line.find("FACTOR") != std::string_view::npos)
                throw_input_error(reader_.position(cells.front()),
                                  "the line states a factor that is not applied here",
                                  "multiply the values by it and leave the line out");
            // "x400,0.5" is a row that went wrong rather than a heading.
            if (cells.size() == divisors_.size() && holds_digit(cells.front().text))
                reader_.number(cells.front());
        }
        if (headings.size() >= divisors_.size())
            take_units(headings);
    }

    void take_units(const std::vector<std::string>& headings) {
        if (const auto unit = stated_wavelength_unit(headings[0])) {
            unit_ = *unit;
            table_.unit = UnitSource::Stated;
        } else if (const auto axis = stated_other_axis(headings[0]); !axis.empty()) {
            throw_input_error(reader_.position(reader_.line_number(), 1),
                              fmt::format("'{}' is not a wavelength", axis),
                              "the first column holds wavelengths, in nm unless its heading names "
                              "another unit");
        }
        // Titles stand above and below the line that names the columns.
        const bool names_columns = names_wavelengths(headings[0]);
        for (std::size_t column = 1; column < divisors_.size(); ++column)
            if (states_percent(headings[column]) && !begins_as_number(headings[column]))
                divisors_[column] = 100.0;
            else if (names_columns)
                divisors_[column] = 1.0;
    }

    void read_row(std::vector<TextToken> cells) {
        while (cells.size() > divisors_.size() && cells.back().text.empty())
            cells.pop_back(); // spreadsheets fill rows up with empty cells
        if (cells.size() != divisors_.size())
            throw_input_error(reader_.position(cells[0]),
                              fmt::format("{} values in this line", cells.size()),
                              fmt::format("{} are needed: a wavelength and its value{}",
                                          divisors_.size(), divisors_.size() > 2 ? "s" : ""));
        table_.columns[0].push_back(wavelength_nm(cells[0]));
        table_.places.push_back({cells[0].line, cells[0].column});
        for (std::size_t column = 1; column < cells.size(); ++column)
            table_.columns[column].push_back(value(cells[column], divisors_[column]));
    }

    double wavelength_nm(const TextToken& cell) const {
        if (cell.text.ends_with("nm") || (unit_.factor == 1.0 && !unit_.reciprocal))
            return reader_.wavelength_nm(cell);
        const double given = reader_.number(cell);
        const double nm = given > 0.0 ? unit_.to_nm(given) : 0.0;
        if (!(nm > 0.0 && nm <= 1e6))
            throw_input_error(reader_.position(cell),
                              fmt::format("{} {} is not a wavelength of light", given, unit_.name),
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
    WavelengthUnit unit_;
    std::vector<double> divisors_; ///< per column: 100 for percent
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
