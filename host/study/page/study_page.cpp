#include "host/study/page/study_page.h"

#include "host/report/colour_map.h"
#include "host/report/data_uri.h"
#include "host/report/page_parts.h"
#include "host/study/page/contact_sheet.h"
#include "host/study/study/study_store.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

using Json = nlohmann::ordered_json;

namespace {

/// Bytes that all images together may take in the page before base64; beyond, they are reduced.
constexpr double image_bytes = 12e6;

template <typename Value>
std::string encoded(const std::vector<Value>& values) {
    return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)});
}

/// Means over blocks of pixels, (height, width, band).
SpectralImage reduced(const SpectralImage& image, int block) {
    SpectralImage small;
    small.width = std::max(1, image.width / block);
    small.height = std::max(1, image.height / block);
    small.bands = image.bands;
    small.values.resize(static_cast<std::size_t>(small.width) *
                        static_cast<std::size_t>(small.height) *
                        static_cast<std::size_t>(image.bands.count));
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
            for (int band = 0; band < image.bands.count; ++band) {
                double sum = 0.0;
                int count = 0;
                for (int v = y * block; v < std::min(image.height, (y + 1) * block); ++v)
                    for (int u = x * block; u < std::min(image.width, (x + 1) * block); ++u) {
                        sum += static_cast<double>(image.at(u, v, band));
                        ++count;
                    }
                small.at(x, y, band) = static_cast<float>(sum / count);
            }
    return small;
}

/// Radiance as largest * (code / 65535)^2: the square keeps the body's digits beside a lamp's
/// highlight (0.1 % at a thousandth of the largest).
Json image_json(const CellResult& cell, double values_each) {
    const SpectralImage image = read_spectral_exr(cell.folder / "image.exr");
    const double pixels = static_cast<double>(image.width) * image.height;
    const int block = std::max(
        1, static_cast<int>(std::ceil(std::sqrt(pixels * image.bands.count / values_each))));
    const SpectralImage small = reduced(image, block);
    const double largest = std::max(
        0.0, static_cast<double>(*std::max_element(small.values.begin(), small.values.end())));
    std::vector<std::uint16_t> codes;
    codes.reserve(small.values.size());
    for (const float value : small.values) {
        const double share =
            largest > 0.0 ? std::max(0.0, static_cast<double>(value)) / largest : 0.0;
        codes.push_back(static_cast<std::uint16_t>(std::lround(65535.0 * std::sqrt(share))));
    }
    return {{"width", small.width},
            {"height", small.height},
            {"block", block},
            {"from", small.bands.from_nm},
            {"step", small.bands.step_nm},
            {"count", small.bands.count},
            {"largest", largest},
            {"codes", encoded(codes)},
            {"picture", png_data_uri(cell.folder / "image.png")}};
}

std::string encoded_matrix(const Eigen::MatrixXd& matrix) {
    std::vector<float> entries;
    for (const double value : matrix.reshaped())
        entries.push_back(static_cast<float>(value));
    return encoded(entries);
}

Json measured_json(const CellMeasurement& measurement) {
    Json json = measurement_json(measurement);
    json["matrix"] = encoded_matrix(measurement.matrix);
    if (measurement.of_sheet())
        json["transmitted"] = encoded_matrix(measurement.transmitted);
    for (const char* key : {"specular", "guided", "straight"})
        json.erase(key);
    json["polar"] = Json::array();
    for (const PolarCurve& curve : measurement.polar)
        json["polar"].push_back(polar_svg(curve, measurement.colours.front().illuminant));
    return json;
}

Json study_json(const Study& study, const StudyResult& result) {
    const SheetLayout layout = sheet_layout(study);
    Json json = {{"title", study.title},
                 {"rowSweeps", layout.row_sweeps},
                 {"columns", layout.columns},
                 {"sweeps", Json::array()},
                 {"cells", Json::array()}};
    for (const Sweep& sweep : study.sweeps) {
        Json values = Json::array();
        for (const SweepValue& value : sweep.values)
            values.push_back(value.shown);
        json["sweeps"].push_back({{"label", sweep.label}, {"values", values}});
    }
    for (const Rgb8& colour : sequential_colours())
        json["colours"].push_back(hex_colour(colour));
    const double values_each = image_bytes / 2.0 / static_cast<double>(result.cells.size());
    for (const CellResult& cell : result.cells) {
        Json entry = {{"index", cell.index}, {"name", cell_name(study, cell)}};
        if (cell.failed())
            entry["error"] = cell.error;
        if (cell.has_image && !cell.failed())
            entry["image"] = image_json(cell, values_each);
        if (cell.measurement && !cell.failed())
            entry["measured"] = measured_json(*cell.measurement);
        json["cells"].push_back(std::move(entry));
    }
    return json;
}

/// The exposure that makes the pictures comparable, and the unit that lengths have.
std::string sheet_notes(const Study& study, const StudyResult& result) {
    std::string notes;
    if (std::any_of(result.cells.begin(), result.cells.end(),
                    [](const CellResult& cell) { return cell.has_image; }))
        notes += fmt::format("<p>All pictures are at the same exposure, {:+.3g} EV{}.</p>\n",
                             result.exposure_ev,
                             study.rendering && study.rendering->exposure_ev
                                 ? ""
                                 : ", chosen so that no sample's body is lost in white "
                                   "(exposure_ev in the study's [render] sets another)");
    if (std::any_of(study.sweeps.begin(), study.sweeps.end(), [](const Sweep& sweep) {
            return sweep.unit.find("unit") != std::string::npos;
        }))
        notes += "<p>Thickness is in units of the material's own: absorption and scattering are "
                 "given per such a unit.</p>\n";
    return notes;
}

} // namespace

std::string study_page(const Study& study, const StudyResult& result) {
    return html_document(
        study.title, std::string(page_style) + study_style,
        "<p>Pick cells; drag along the wavelength, in a spectrum too, or along the excitation; "
        "read values under the pointer.</p>\n" +
            sheet_notes(study, result) +
            "<noscript><p>This page needs scripts; table.csv and the folder cells hold the same "
            "results.</p></noscript>\n"
            "<section id=\"sheet\"></section>\n<section id=\"controls\"></section>\n"
            "<section id=\"panels\"></section>\n" +
            script_data("study-data", study_json(study, result)) + "<script>\n" + page_script +
            study_script + "</script>\n");
}

} // namespace reradiant
