#include "host/spectral/files/matrix_formats.h"

#include "host/spectral/evidence/undeclared_table.h"
#include "host/spectral/files/matrix_csv_header.h"
#include "host/spectral/files/matrix_csv_table.h"
#include "host/spectral/text/csv_lines.h"
#include "host/spectral/text/text_reader.h"
#include "host/spectral/text/wavelength_unit.h"
#include "reradiant/spectral_files.h"

#include <fmt/core.h>

#include <cstdlib>
#include <optional>
#include <utility>

namespace reradiant {

namespace {

/// The whole of a re-radiation CSV.
class CsvReader {
public:
    CsvReader(const std::filesystem::path& file, Gaps gaps, const TableForm& told)
        : reader_(file, TextFormat::Table, told.decimal), gaps_(gaps), told_(told) {}

    ReradiationMatrix read() {
        const std::vector<TextToken> headings = find_headings();
        const SourcePosition at = reader_.position(headings[0]);
        const std::optional<LongColumns> columns = long_columns(reader_, headings);
        if (!is_declared(columns.has_value()))
            refuse_undeclared(headings, columns, at);
        read_value_unit(reader_, headings[columns ? columns->value : 0], header_);
        CellReader cells(reader_, header_,
                         columns ? WavelengthUnit{} : axis_unit(reader_, headings));
        CsvBody body;
        if (columns) {
            body = read_long(cells, *columns, gaps_);
        } else {
            WideTable table = read_wide(cells, headings);
            fill_gaps(table, reader_);
            body = sorted_body(std::move(table), rows_are_emission());
        }
        take_percent_signs(cells.signs());
        add_told(reader_, header_, told_);
        require_consistent_unit(header_, told_);
        ReradiationMatrix matrix = assemble(std::move(body));
        if (header_.quantity == MatrixQuantity::DensityPerNm)
            scale_off_diagonal(matrix, matrix.excitation.step_nm);
        refuse_undeclared_anti_stokes(matrix, at);
        return matrix;
    }

private:
    /// The headings of the long form say which wavelength is which.
    bool is_declared(bool is_long) const {
        return (header_.quantity || told_.quantity) &&
               (is_long || header_.rows_are_emission || told_.rows_are_emission);
    }
    bool rows_are_emission() const {
        return told_.rows_are_emission ? *told_.rows_are_emission : *header_.rows_are_emission;
    }

    /// The cells of the line of headings, the corner among them.
    std::vector<TextToken> find_headings() {
        for (std::string_view line; reader_.next_line(line);) {
            if (is_remark(line))
                read_csv_header_line(reader_, line, header_);
            if (!is_line_of_cells(line))
                continue;
            std::vector<TextToken> cells = table_cells(reader_, line);
            drop_padding(cells, 1);
            switch (heading_kind(cells, next_cells(reader_))) {
            case HeadingKind::Title:
                refuse_lost_key(reader_, line);
                continue;
            case HeadingKind::Row:
                throw_input_error(reader_.position(cells[0]), "the line of headings is missing",
                                  "begin the table with the wavelengths of its columns, as in "
                                  "'nm,300,310,...', or with excitation_nm,emission_nm,value; "
                                  "quantity and orientation are declared in lines of '#' above");
            case HeadingKind::HeadingsWithoutCorner:
                cells.insert(cells.begin(), {{}, cells[0].line, cells[0].column});
                break;
            case HeadingKind::Headings:
                break;
            }
            return cells;
        }
        throw_input_error(reader_.end_position(), "no matrix in this file",
                          "spectra/README.md shows what a table of re-radiation looks like");
    }

    /// Refuses a table that lacks a declaration; the error says what its values speak for.
    [[noreturn]] void refuse_undeclared(const std::vector<TextToken>& headings,
                                        const std::optional<LongColumns>& columns,
                                        const SourcePosition& at) {
        TableForm told = told_;
        if (columns)
            header_.rows_are_emission = true;
        if (header_.factor && !told.scale)
            told.scale = header_.factor;
        read_value_unit(reader_, headings[columns ? columns->value : 0], header_);
        UndeclaredTable table{.file = reader_.name(),
                              .quantity = told_.quantity ? told_.quantity : header_.quantity,
                              .rows_are_emission = told_.rows_are_emission
                                                       ? told_.rows_are_emission
                                                       : header_.rows_are_emission,
                              .told = told,
                              .is_scaled = told_.scale || header_.is_percent || header_.factor,
                              .is_measured = header_.kind.has_value(),
                              .needs_decimal = !reader_.decimal_doubt().empty()};
        try {
            CellReader cells(reader_, header_,
                             columns ? WavelengthUnit{} : axis_unit(reader_, headings));
            CsvBody body;
            if (columns) {
                body = read_long(cells, *columns, Gaps::BecomeNan);
            } else {
                WideTable wide = read_wide(cells, headings);
                table.has_gaps = !wide.gaps.empty();
                body = sorted_body(std::move(wide), true);
            }
            table.is_scaled = table.is_scaled || header_.is_percent || header_.factor;
            table.has_percent_signs = cells.signs().some;
            table.as_rows_emission = assemble(std::move(body));
        } catch (const Error&) { // but for decimals, what the command below would refuse as well
            if (!table.needs_decimal)
                throw;
        }
        refuse_undeclared_table(table, at);
    }

    /// Impossible entries of a table that says nothing of itself may be left out: they are 0. Input
    /// Error at any other gap, or NaN.
    void fill_gaps(WideTable& table, const TextReader& reader) const {
        const bool may_leave_out = told_ != TableForm{} && !told_.anti_stokes_allowed &&
                                   !header_.anti_stokes_allowed.value_or(false);
        for (const WideTable::Gap& gap : table.gaps) {
            const double row_nm = table.rows[static_cast<std::size_t>(gap.row)].nm;
            const double column_nm = table.columns[static_cast<std::size_t>(gap.column)].nm;
            if (may_leave_out && (rows_are_emission() ? row_nm < column_nm : column_nm < row_nm))
                table.values(gap.row, gap.column) = 0.0;
            else if (gaps_ == Gaps::Refused)
                reader.number(gap.cell); // refuses it by name
        }
    }

    void take_percent_signs(const PercentSigns& signs) {
        if (!signs.some)
            return;
        if (signs.without)
            throw_input_error(*signs.without, "this value has no percent sign, others have",
                              "write all values with it or none");
        if (told_.scale.value_or(0.01) != 0.01 || !header_.is_percent.value_or(true) ||
            header_.factor)
            throw_input_error(reader_.end_position(),
                              "the values have percent signs, and another scale is said for them",
                              "leave one of the two out");
        header_.is_percent = true;
    }

    ReradiationMatrix assemble(CsvBody body) const {
        const auto spacing = [](const std::vector<PlacedWavelength>& axis) {
            return axis.size() > 1 && axis[1].nm > axis[0].nm ? axis[1].nm - axis[0].nm : 1.0;
        };
        ReradiationMatrix matrix;
        // An axis of one band is as wide as it says, else as the other axis's bands.
        matrix.emission = axis_grid(body.emission, "emission",
                                    header_.emission_step_nm.value_or(spacing(body.excitation)));
        matrix.excitation = axis_grid(body.excitation, "excitation",
                                      header_.excitation_step_nm.value_or(spacing(body.emission)));
        matrix.values = std::move(body.values);
        matrix.kind = header_.kind.value_or(MatrixKind::Model);
        matrix.anti_stokes_allowed = header_.anti_stokes_allowed.value_or(false);
        matrix.geometry = header_.geometry.value_or("");
        scale(matrix.values, told_.scale.value_or(header_.is_percent.value_or(false) ? 0.01 : 1.0));
        return matrix;
    }

    /// Keeps 15 digits of percent and permille, so that 0.47 % becomes 0.0047 as it would be
    /// written: neither a product nor a quotient of doubles does that.
    static void scale(Eigen::MatrixXd& values, double factor) {
        values *= factor;
        if (factor == 0.01 || factor == 0.001)
            values = values.unaryExpr([](double value) {
                return std::strtod(fmt::format("{:.15g}", value).c_str(), nullptr);
            });
    }

    /// Unit of both axes of the wide form, by the heading of its first column. That may be any
    /// other text or none where wavelengths follow it.
    static WavelengthUnit axis_unit(const TextReader& reader,
                                    const std::vector<TextToken>& headings) {
        const TextToken& heading = headings[0];
        const auto unit = stated_wavelength_unit(heading.text);
        const bool is_known = unit || names_wavelengths(heading.text) ||
                              (are_bands(headings, 1) && stated_other_axis(heading.text).empty());
        if (!is_known && !is_gap(heading.text))
            throw_input_error(reader.position(heading),
                              fmt::format("'{}' is not a wavelength", heading.text),
                              "rows and columns hold wavelengths; begin the headings with 'nm,'");
        if (unit && unit->reciprocal)
            throw_input_error(reader.position(heading),
                              fmt::format("bands in {} are not equally spaced in nm", unit->name),
                              "resample the matrix to equal steps of wavelength");
        return unit.value_or(WavelengthUnit{});
    }

    TextReader reader_;
    Gaps gaps_;
    const TableForm& told_;
    CsvHeader header_;
};

} // namespace

ReradiationMatrix read_matrix_csv(const std::filesystem::path& file, Gaps gaps,
                                  const TableForm& form) {
    return CsvReader(file, gaps, form).read();
}

} // namespace reradiant
