#include "host/atomic_file.h"
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
    CellReader(TextReader& reader, const WavelengthUnit& unit, Gaps gaps)
        : reader_(reader), unit_(unit), gaps_(gaps) {}

    /// Cells of the next line that has any, comments skipped; empty behind the last. Spreadsheets
    /// fill lines up with empty cells: those beyond `most` are dropped.
    std::vector<TextToken> next(std::size_t most) {
        for (std::string_view line; reader_.next_line(line);) {
            if (trimmed(line).starts_with('#'))
                continue;
            std::vector<TextToken> cells = reader_.split_cells(line);
            const bool has_any = std::any_of(cells.begin(), cells.end(), [](const TextToken& cell) {
                return !cell.text.empty();
            });
            while (cells.size() > most && cells.back().text.empty())
                cells.pop_back();
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
    while (headings.size() > 1 && headings.back().text.empty())
        headings.pop_back();
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

LongEntries read_long_entries(CellReader& cells) {
    const TextReader& reader = cells.reader();
    LongEntries entries;
    for (auto tokens = cells.next(3); !tokens.empty(); tokens = cells.next(3)) {
        if (tokens.size() != 3)
            throw_input_error(reader.position(tokens.back()),
                              fmt::format("{} values in this line", tokens.size()),
                              "write excitation_nm,emission_nm,value");
        const LongEntry entry{cells.value(tokens[2]), cells.wavelength(tokens[1]),
                              cells.wavelength(tokens[0])};
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

CsvBody read_long(CellReader& cells, Gaps gaps) {
    const LongEntries entries = read_long_entries(cells);
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

std::string header_text(const ReradiationMatrix& matrix, const MatrixCsvForm& form) {
    std::string text =
        fmt::format("# reradiation\n# quantity: {}\n# orientation: {}\n# kind: {}\n",
                    form.quantity == MatrixQuantity::PerBand ? "per-band" : "density-per-nm",
                    form.rows_are_emission ? "rows-emission" : "rows-excitation",
                    matrix.kind == MatrixKind::Model ? "model" : "measured");
    std::string geometry = matrix.geometry;
    std::replace_if(
        geometry.begin(), geometry.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    if (!geometry.empty())
        text += fmt::format("# geometry: {}\n", geometry);
    if (matrix.anti_stokes_allowed)
        text += "# anti-stokes: allowed\n";
    if (matrix.emission.count == 1)
        text += fmt::format("# emission-step-nm: {}\n", matrix.emission.step_nm);
    if (matrix.excitation.count == 1)
        text += fmt::format("# excitation-step-nm: {}\n", matrix.excitation.step_nm);
    return text;
}

} // namespace

ReradiationMatrix read_matrix_csv(const std::filesystem::path& file, Gaps gaps) {
    TextReader reader(file);
    CsvHeader header;
    for (std::string_view line; reader.next_line(line);) {
        if (trimmed(line).empty())
            continue;
        if (trimmed(line).starts_with('#')) {
            read_csv_header_line(reader, line, header);
            continue;
        }
        require_declared(reader, header);
        const std::vector<TextToken> headings = reader.split_cells(line);
        const bool is_long = headings[0].text == "excitation_nm";
        if (is_long && (headings.size() != 3 || headings[1].text != "emission_nm" ||
                        headings[2].text != "value"))
            throw_input_error(reader.position(headings[0]), "these headings are not known",
                              "write excitation_nm,emission_nm,value");
        CellReader cells(reader, is_long ? WavelengthUnit{} : axis_unit(reader, headings[0]), gaps);
        const ReradiationMatrix matrix =
            assemble(header, is_long ? read_long(cells, gaps)
                                     : read_wide(cells, headings, *header.rows_are_emission));
        refuse_undeclared_anti_stokes(matrix, reader.position(headings[0]));
        return matrix;
    }
    throw_input_error(reader.end_position(), "no matrix in this file",
                      "see 'Re-radiation CSV' in the README");
}

void write_reradiation_csv(const std::filesystem::path& file, const ReradiationMatrix& matrix,
                           const MatrixCsvForm& form) {
    ReradiationMatrix scaled = matrix;
    if (form.quantity == MatrixQuantity::DensityPerNm)
        scale_off_diagonal(scaled, 1.0 / matrix.excitation.step_nm);
    const Eigen::MatrixXd table =
        form.rows_are_emission ? scaled.values : Eigen::MatrixXd(scaled.values.transpose());
    const WavelengthGrid& rows = form.rows_are_emission ? matrix.emission : matrix.excitation;
    const WavelengthGrid& columns = form.rows_are_emission ? matrix.excitation : matrix.emission;
    std::string text = header_text(matrix, form) + "nm";
    for (int column = 0; column < columns.count; ++column)
        text += fmt::format(",{}", columns.centre_nm(column));
    text += '\n';
    for (int row = 0; row < rows.count; ++row) {
        text += fmt::format("{}", rows.centre_nm(row));
        // fmt prints the shortest text that reads back as the same double.
        for (int column = 0; column < columns.count; ++column)
            text += fmt::format(",{}", table(row, column));
        text += '\n';
    }
    write_text_atomically(file, text);
}

} // namespace reradiant
