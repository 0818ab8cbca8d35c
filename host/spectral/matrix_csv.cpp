#include "host/spectral/csv_lines.h"
#include "host/spectral/matrix_csv_header.h"
#include "host/spectral/matrix_formats.h"
#include "host/spectral/matrix_io.h"
#include "host/spectral/text_reader.h"
#include "host/spectral/wavelength_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace reradiant {

namespace {

/// Both axes and the values, rows = emission, in the file's quantity.
struct CsvBody {
    std::vector<PlacedWavelength> emission, excitation;
    Eigen::MatrixXd values;
};

/// Reads the cells of a line, and what stands in them.
class CellReader {
public:
    /// What '#' lines say below the headings counts too.
    CellReader(TextReader& reader, CsvHeader& header, const WavelengthUnit& unit, Gaps gaps)
        : reader_(reader), header_(header), unit_(unit), gaps_(gaps) {}

    /// Cells of the next line that has any; empty behind the last. Empty cells beyond `most` are
    /// dropped.
    std::vector<TextToken> next(std::size_t most) {
        for (std::string_view line; reader_.next_line(line);) {
            if (is_remark(line)) {
                read_csv_header_line(reader_, line, header_);
                continue;
            }
            std::vector<TextToken> cells = reader_.split_cells(line);
            const bool has_any = std::any_of(cells.begin(), cells.end(), [](const TextToken& cell) {
                return !cell.text.empty();
            });
            drop_padding(cells, most);
            if (has_any)
                return cells;
        }
        return {};
    }

    PlacedWavelength wavelength(const TextToken& cell) const {
        const double factor = cell.text.ends_with("nm") ? 1.0 : unit_.factor;
        return {factor * reader_.wavelength_nm(cell), reader_.position(cell),
                factor * half_last_digit(cell.text)};
    }

    double value(const TextToken& cell) const {
        if (gaps_ == Gaps::BecomeNan && is_gap(cell.text))
            return std::numeric_limits<double>::quiet_NaN();
        return reader_.number(cell);
    }

    const TextReader& reader() const { return reader_; }

private:
    TextReader& reader_;
    CsvHeader& header_;
    WavelengthUnit unit_;
    Gaps gaps_;
};

/// The table with its rows and columns in the order of wavelengths, rows = emission.
CsvBody sorted_body(std::vector<PlacedWavelength> rows, std::vector<PlacedWavelength> columns,
                    const Eigen::MatrixXd& table, bool rows_are_emission) {
    const std::vector<int> row_order =
        sort_axis(rows, rows_are_emission ? "emission" : "excitation");
    const std::vector<int> column_order =
        sort_axis(columns, rows_are_emission ? "excitation" : "emission");
    const Eigen::MatrixXd sorted = table(row_order, column_order);
    if (rows_are_emission)
        return {std::move(rows), std::move(columns), sorted};
    return {std::move(columns), std::move(rows), sorted.transpose()};
}

CsvBody read_wide(CellReader& cells, std::vector<TextToken> headings, bool rows_are_emission) {
    const TextReader& reader = cells.reader();
    if (headings.size() < 2)
        throw_input_error(reader.position(headings[0]), "no wavelengths in the line of headings",
                          "write 'nm,300,310,...'");
    std::vector<PlacedWavelength> columns, rows;
    for (std::size_t k = 1; k < headings.size(); ++k)
        columns.push_back(cells.wavelength(headings[k]));
    std::vector<double> values;
    for (auto tokens = cells.next(headings.size()); !tokens.empty();
         tokens = cells.next(headings.size())) {
        if (tokens.size() != headings.size())
            throw_input_error(reader.position(tokens.back()),
                              fmt::format("{} values in this row", tokens.size() - 1),
                              fmt::format("the headings name {}", columns.size()));
        rows.push_back(cells.wavelength(tokens[0]));
        require_matrix_size(rows.back().position, rows.size(), columns.size());
        for (std::size_t k = 1; k < tokens.size(); ++k)
            values.push_back(cells.value(tokens[k]));
    }
    if (rows.empty())
        throw_input_error(reader.end_position(), "no rows after the headings",
                          "every row holds a wavelength and its values");
    const Eigen::MatrixXd table =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            values.data(), static_cast<Eigen::Index>(rows.size()),
            static_cast<Eigen::Index>(columns.size()));
    return sorted_body(std::move(rows), std::move(columns), table, rows_are_emission);
}

struct LongEntry {
    double value;
    PlacedWavelength emission, excitation;
};
using LongEntries = std::map<std::pair<double, double>, LongEntry>; // (emission, excitation)

/// Which columns of the long form hold what.
struct LongColumns {
    std::size_t excitation = 0, emission = 1, value = 2;
};

/// Empty for headings of the wide form. Input Error where a column of the long form lacks.
std::optional<LongColumns> long_columns(const TextReader& reader,
                                        const std::vector<TextToken>& headings) {
    if (!names_long_form(headings))
        return std::nullopt;
    const auto column = [&](std::string_view name) {
        return static_cast<std::size_t>(std::find_if(headings.begin(), headings.end(),
                                                     [&](const TextToken& heading) {
                                                         return lower_case(heading.text) == name;
                                                     }) -
                                        headings.begin());
    };
    const LongColumns columns{column("excitation_nm"), column("emission_nm"), column("value")};
    if (headings.size() != 3 || columns.excitation + columns.emission + columns.value != 3)
        throw_input_error(reader.position(headings[0]), "these headings are not known",
                          "write excitation_nm,emission_nm,value");
    return columns;
}

LongEntries read_long_entries(CellReader& cells, const LongColumns& columns) {
    const TextReader& reader = cells.reader();
    LongEntries entries;
    for (auto tokens = cells.next(3); !tokens.empty(); tokens = cells.next(3)) {
        if (tokens.size() != 3)
            throw_input_error(reader.position(tokens.back()),
                              fmt::format("{} values in this line", tokens.size()),
                              "write excitation_nm,emission_nm,value");
        const LongEntry entry{cells.value(tokens[columns.value]),
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

CsvBody read_long(CellReader& cells, const LongColumns& columns, Gaps gaps) {
    const LongEntries entries = read_long_entries(cells, columns);
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

ReradiationMatrix assemble(const CsvHeader& header, CsvBody body) {
    const auto spacing = [](const std::vector<PlacedWavelength>& axis) {
        return axis.size() > 1 && axis[1].nm > axis[0].nm ? axis[1].nm - axis[0].nm : 1.0;
    };
    require_consistent_unit(header);
    ReradiationMatrix matrix;
    // An axis of one band is as wide as it says, else as the other axis's bands.
    matrix.emission = axis_grid(body.emission, "emission",
                                header.emission_step_nm.value_or(spacing(body.excitation)));
    matrix.excitation = axis_grid(body.excitation, "excitation",
                                  header.excitation_step_nm.value_or(spacing(body.emission)));
    matrix.values = std::move(body.values);
    matrix.kind = header.kind.value_or(MatrixKind::Model);
    matrix.anti_stokes_allowed = header.anti_stokes_allowed.value_or(false);
    matrix.geometry = header.geometry.value_or("");
    if (header.is_percent.value_or(false))
        matrix.values /= 100.0;
    if (*header.quantity == MatrixQuantity::DensityPerNm)
        scale_off_diagonal(matrix, matrix.excitation.step_nm);
    return matrix;
}

/// Unit of both axes of the wide form, by the heading of its first column.
WavelengthUnit axis_unit(const TextReader& reader, const TextToken& heading) {
    const auto unit = stated_wavelength_unit(heading.text);
    if (!unit && !names_wavelengths(heading.text))
        throw_input_error(reader.position(heading), "the line of headings is missing",
                          "begin it with 'nm,' or write excitation_nm,emission_nm,value");
    if (unit && unit->reciprocal)
        throw_input_error(reader.position(heading),
                          fmt::format("bands in {} are not equally spaced in nm", unit->name),
                          "resample the matrix to equal steps of wavelength");
    return unit.value_or(WavelengthUnit{});
}

} // namespace

ReradiationMatrix read_matrix_csv(const std::filesystem::path& file, Gaps gaps) {
    TextReader reader(file);
    CsvHeader header;
    for (std::string_view line; reader.next_line(line);) {
        if (is_remark(line))
            read_csv_header_line(reader, line, header);
        if (!is_line_of_cells(line))
            continue;
        std::vector<TextToken> headings = reader.split_cells(line);
        drop_padding(headings, 1);
        if (!header.quantity && !header.rows_are_emission && is_title(headings))
            continue;
        require_declared(reader, header);
        const std::optional<LongColumns> columns = long_columns(reader, headings);
        if (!columns)
            read_value_unit(reader, headings[0], header);
        CellReader cells(reader, header,
                         columns ? WavelengthUnit{} : axis_unit(reader, headings[0]), gaps);
        CsvBody body = columns ? read_long(cells, *columns, gaps)
                               : read_wide(cells, headings, *header.rows_are_emission);
        const ReradiationMatrix matrix = assemble(header, std::move(body));
        refuse_undeclared_anti_stokes(matrix, reader.position(headings[0]));
        return matrix;
    }
    throw_input_error(reader.end_position(), "no matrix in this file",
                      "see 'Re-radiation CSV' in the README");
}

} // namespace reradiant
