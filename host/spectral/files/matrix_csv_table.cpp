#include "host/spectral/files/matrix_csv_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace reradiant {

namespace {

struct LongEntry {
    double value;
    PlacedWavelength emission, excitation;
};
using LongEntries = std::map<std::pair<double, double>, LongEntry>; // (emission, excitation)

LongEntries read_long_entries(CellReader& cells, const LongColumns& columns, Gaps gaps) {
    const TextReader& reader = cells.reader();
    LongEntries entries;
    for (auto tokens = cells.next(3); !tokens.empty(); tokens = cells.next(3)) {
        if (tokens.size() != 3)
            throw_input_error(reader.position(tokens.back()),
                              fmt::format("{} values in this line", tokens.size()),
                              "write excitation_nm,emission_nm,value");
        const TextToken& value = tokens[columns.value];
        const LongEntry entry{gaps == Gaps::BecomeNan ? cells.value_or_gap(value)
                                                      : cells.value(value),
                              cells.wavelength(tokens[columns.emission]),
                              cells.wavelength(tokens[columns.excitation])};
        if (!entries.emplace(std::pair{entry.emission.nm, entry.excitation.nm}, entry).second)
            throw_input_error(entry.excitation.position,
                              fmt::format("excitation {} nm, emission {} nm is given twice",
                                          entry.excitation.nm, entry.emission.nm),
                              "keep one of the two lines");
        require_matrix_size(entry.excitation.position, entries.size(), 1);
    }
    if (entries.empty())
        throw_input_error(reader.end_position(), "no values after the headings",
                          "every line holds excitation_nm,emission_nm,value");
    return entries;
}

} // namespace

std::vector<TextToken> CellReader::next(std::size_t most) {
    for (std::string_view line; reader_.next_line(line);) {
        if (is_remark(line)) {
            read_csv_header_line(reader_, line, header_);
            continue;
        }
        std::vector<TextToken> cells = table_cells(reader_, line);
        const bool has_any = std::any_of(cells.begin(), cells.end(),
                                         [](const TextToken& cell) { return !cell.text.empty(); });
        drop_padding(cells, most);
        if (has_any)
            return cells;
    }
    return {};
}

PlacedWavelength CellReader::wavelength(const TextToken& cell) const {
    const double factor = cell.text.ends_with("nm") ? 1.0 : unit_.factor;
    return {factor * reader_.wavelength_nm(cell), reader_.position(cell),
            factor * half_last_digit(cell.text)};
}

double CellReader::value(TextToken cell) {
    if (cell.text.ends_with('%')) {
        cell.text = trimmed(cell.text.substr(0, cell.text.size() - 1));
        signs_.some = true;
        return reader_.number(cell);
    }
    const double number = reader_.number(cell);
    if (number != 0.0 && !signs_.without)
        signs_.without = reader_.position(cell);
    return number;
}

double CellReader::value_or_gap(const TextToken& cell) {
    return is_gap(cell.text) ? std::numeric_limits<double>::quiet_NaN() : value(cell);
}

CsvBody sorted_body(WideTable table, bool rows_are_emission) {
    const std::vector<int> row_order =
        sort_axis(table.rows, rows_are_emission ? "emission" : "excitation");
    const std::vector<int> column_order =
        sort_axis(table.columns, rows_are_emission ? "excitation" : "emission");
    const Eigen::MatrixXd sorted = table.values(row_order, column_order);
    if (rows_are_emission)
        return {std::move(table.rows), std::move(table.columns), sorted};
    return {std::move(table.columns), std::move(table.rows), sorted.transpose()};
}

WideTable read_wide(CellReader& cells, const std::vector<TextToken>& headings) {
    const TextReader& reader = cells.reader();
    if (headings.size() < 2)
        throw_input_error(reader.position(headings[0]), "no wavelengths in the line of headings",
                          "write 'nm,300,310,...'");
    WideTable table;
    for (std::size_t k = 1; k < headings.size(); ++k)
        table.columns.push_back(cells.wavelength(headings[k]));
    std::vector<double> values;
    for (auto tokens = cells.next(headings.size()); !tokens.empty();
         tokens = cells.next(headings.size())) {
        if (tokens.size() != headings.size()) {
            const bool has_twice = tokens.size() + 1 >= 2 * table.columns.size();
            throw_input_error(
                reader.position(tokens.back()),
                fmt::format("{} values in this row", tokens.size() - 1),
                fmt::format("the headings name {}{}", table.columns.size(),
                            has_twice ? "; where commas part the cells and stand for decimal "
                                        "points, too, save the sheet with semicolons or tabs"
                                      : ""));
        }
        table.rows.push_back(cells.wavelength(tokens[0]));
        require_matrix_size(table.rows.back().position, table.rows.size(), table.columns.size());
        for (std::size_t k = 1; k < tokens.size(); ++k) {
            values.push_back(cells.value_or_gap(tokens[k]));
            if (is_gap(tokens[k].text))
                table.gaps.push_back({static_cast<Eigen::Index>(table.rows.size()) - 1,
                                      static_cast<Eigen::Index>(k) - 1, tokens[k]});
        }
    }
    if (table.rows.empty())
        throw_input_error(reader.end_position(), "no rows after the headings",
                          "every row holds a wavelength and its values");
    table.values =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            values.data(), static_cast<Eigen::Index>(table.rows.size()),
            static_cast<Eigen::Index>(table.columns.size()));
    return table;
}

std::optional<LongColumns> long_columns(const TextReader& reader,
                                        const std::vector<TextToken>& headings) {
    if (!names_long_form(headings))
        return std::nullopt;
    const auto column = [&](LongRole role) {
        return static_cast<std::size_t>(std::find_if(headings.begin(), headings.end(),
                                                     [&](const TextToken& heading) {
                                                         return long_role(heading.text) == role;
                                                     }) -
                                        headings.begin());
    };
    const LongColumns columns{column(LongRole::Excitation), column(LongRole::Emission),
                              column(LongRole::Value)};
    if (headings.size() != 3 || columns.excitation + columns.emission + columns.value != 3)
        throw_input_error(reader.position(headings[0]), "these headings are not known",
                          "write excitation_nm,emission_nm,value");
    return columns;
}

CsvBody read_long(CellReader& cells, const LongColumns& columns, Gaps gaps) {
    const LongEntries entries = read_long_entries(cells, columns, gaps);
    const TextReader& reader = cells.reader();
    std::map<double, PlacedWavelength> emission, excitation;
    for (const auto& [key, entry] : entries) {
        emission.emplace(key.first, entry.emission);
        excitation.emplace(key.second, entry.excitation);
    }
    CsvBody body;
    for (const auto& [nm, placed] : emission)
        body.emission.push_back(placed);
    for (const auto& [nm, placed] : excitation)
        body.excitation.push_back(placed);
    require_matrix_size(reader.position(1, 1), emission.size(), excitation.size());
    body.values.setZero(static_cast<Eigen::Index>(emission.size()),
                        static_cast<Eigen::Index>(excitation.size()));
    for (std::size_t o = 0; o < body.emission.size(); ++o) {
        for (std::size_t i = 0; i < body.excitation.size(); ++i) {
            const double emission_nm = body.emission[o].nm, excitation_nm = body.excitation[i].nm;
            const auto found = entries.find({emission_nm, excitation_nm});
            // Impossible entries may be left out; any other gap is a mistake.
            if (found == entries.end() && gaps == Gaps::BecomeNan)
                body.values(static_cast<Eigen::Index>(o), static_cast<Eigen::Index>(i)) =
                    std::numeric_limits<double>::quiet_NaN();
            else if (found == entries.end() && emission_nm >= excitation_nm)
                throw_input_error(body.emission[o].position,
                                  fmt::format("excitation {} nm, emission {} nm is missing",
                                              excitation_nm, emission_nm),
                                  "only emission below its excitation may be left out");
            if (found != entries.end())
                body.values(static_cast<Eigen::Index>(o), static_cast<Eigen::Index>(i)) =
                    found->second.value;
        }
    }
    return body;
}

} // namespace reradiant
