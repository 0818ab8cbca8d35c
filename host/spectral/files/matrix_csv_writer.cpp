#include "reradiant/spectral_files.h"

#include "host/base/atomic_file.h"
#include "host/spectral/files/matrix_formats.h"

#include <fmt/core.h>

#include <algorithm>

namespace reradiant {

namespace {

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
            text += fmt::format(",{}", table(row, column) + 0.0); // 0 rather than -0
        text += '\n';
    }
    write_text_atomically(file, text);
}

} // namespace reradiant
