#pragma once

#include "host/study/study/study.h"

#include <nlohmann/json.hpp>

namespace reradiant {

/// image.exr and image.png of a cell.
void keep_image(CellResult& cell, const SpectralImage& image, double exposure_ev);

/// matrix.csv, matrix.svg and polar-THETA.svg of what was measured, of a sheet also transmitted.csv
/// and transmitted.svg, then cell.json, which says that the cell is done. `identity` is what its
/// results depend on.
void keep_cell(const CellResult& cell, const std::string& identity);

/// Fills a cell from an earlier run; false when there is none, when it is of another identity, or
/// when its files are damaged.
bool restore_cell(CellResult& cell, const std::string& identity);

/// A `ToldCell` is what a member of a team tells the leader of a cell; its results lie in the
/// folder.
struct ToldCell {
    std::size_t index = 0;
    std::string identity, error;
    bool kept = false;
};
std::string cells_text(const std::vector<CellResult>& cells);
std::vector<ToldCell> told_cells(const std::string& text);

nlohmann::ordered_json measurement_json(const CellMeasurement& measurement);

/// The plots of a cell as SVG, for files and pages.
std::string matrix_svg(const WavelengthGrid& bands, const Eigen::MatrixXd& matrix);
std::string polar_svg(const PolarCurve& curve, const std::string& illuminant);

/// table.csv: a row for every colour that was seen, and for the mean of every image that was
/// rendered (`source`), with the swept values in front and beta_T of every band behind.
void write_study_table(const std::filesystem::path& file, const Study& study,
                       const StudyResult& result);

} // namespace reradiant
