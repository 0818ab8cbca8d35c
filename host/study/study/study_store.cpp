#include "host/study/study/study_store.h"

#include "host/base/atomic_file.h"
#include "host/base/json_numbers.h"
#include "host/base/regular_file.h"
#include "host/film/colour_image.h"
#include "host/report/json_file.h"
#include "host/report/polar_plot.h"
#include "host/report/svg.h"
#include "reradiant/error.h"
#include "reradiant/reradiation.h"
#include "reradiant/spectral_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}
double number_from(const Json& json) {
    return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

template <typename Values>
Json list_json(const Values& values) {
    Json list = Json::array();
    for (const double value : values)
        list.push_back(finite_or_null(value));
    return list;
}
std::vector<double> list_from(const Json& json) {
    std::vector<double> values;
    for (const Json& entry : json)
        values.push_back(number_from(entry));
    return values;
}
std::array<double, 3> triple_from(const Json& json) {
    return {number_from(json.at(0)), number_from(json.at(1)), number_from(json.at(2))};
}

Json colour_json(const SeenColour& colour) {
    return {{"illuminant", colour.illuminant},
            {"theta_i_deg", colour.theta_i_deg},
            {"theta_o_deg", colour.theta_o_deg},
            {"phi_deg", colour.phi_deg},
            {"XYZ", list_json(colour.xyz)},
            {"Lab", list_json(colour.lab)},
            {"quantum_yield", finite_or_null(colour.quantum_yield)},
            {"reflected", finite_or_null(colour.reflected)},
            {"transmitted", finite_or_null(colour.transmitted)},
            {"guided", finite_or_null(colour.guided)},
            {"beta_T", list_json(colour.beta_t)}};
}

SeenColour colour_from(const Json& json) {
    return {json.at("illuminant").get<std::string>(),
            json.at("theta_i_deg").get<double>(),
            json.at("theta_o_deg").get<double>(),
            json.at("phi_deg").get<double>(),
            triple_from(json.at("XYZ")),
            triple_from(json.at("Lab")),
            list_from(json.at("beta_T")),
            number_from(json.at("quantum_yield")),
            number_from(json.at("reflected")),
            number_from(json.at("transmitted")),
            number_from(json.at("guided"))};
}

Eigen::MatrixXd matrix_from(const Json& json, int bands) {
    const std::vector<double> entries = list_from(json);
    if (bands < 1 ||
        entries.size() != static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands))
        throw_runtime_error("the cell's matrix has another size than its bands");
    return Eigen::Map<const Eigen::MatrixXd>(entries.data(), bands, bands);
}

CellMeasurement measurement_from(const Json& json) {
    CellMeasurement measurement;
    const Json& bands = json.at("bands");
    measurement.bands = {bands.at("from_nm").get<double>(), bands.at("step_nm").get<double>(),
                         whole_number<int>(bands.at("count"))};
    measurement.matrix = matrix_from(json.at("matrix"), measurement.bands.count);
    measurement.specular = list_from(json.at("specular"));
    if (json.contains("transmitted")) {
        measurement.transmitted = matrix_from(json.at("transmitted"), measurement.bands.count);
        measurement.guided = matrix_from(json.at("guided"), measurement.bands.count);
        measurement.straight = list_from(json.at("straight"));
    }
    for (const Json& colour : json.at("colours"))
        measurement.colours.push_back(colour_from(colour));
    for (const Json& curve : json.at("polar"))
        measurement.polar.push_back({curve.at("theta_i_deg").get<double>(),
                                     list_from(curve.at("angle_deg")),
                                     list_from(curve.at("diffuse")), list_from(curve.at("total"))});
    measurement.notes = json.at("notes").get<std::vector<std::string>>();
    return measurement;
}

/// Writes a matrix that was measured, and its picture.
void keep_matrix(const CellResult& cell, const CellMeasurement& measurement,
                 const Eigen::MatrixXd& values, const std::string& name) {
    ReradiationMatrix matrix;
    matrix.emission = matrix.excitation = measurement.bands;
    matrix.values = values;
    matrix.geometry = fmt::format("{:g}/hemispherical", measurement.colours.front().theta_i_deg);
    write_reradiation(cell.folder / (name + ".csv"), matrix);
    write_text_atomically(cell.folder / (name + ".svg"), matrix_svg(measurement.bands, values));
}

void keep_plots(const CellResult& cell, const CellMeasurement& measurement) {
    keep_matrix(cell, measurement, measurement.matrix, "matrix");
    if (measurement.of_sheet())
        keep_matrix(cell, measurement, measurement.transmitted, "transmitted");
    for (const PolarCurve& curve : measurement.polar)
        write_text_atomically(cell.folder / fmt::format("polar-{:g}.svg", curve.theta_i_deg),
                              polar_svg(curve, measurement.colours.front().illuminant));
}

} // namespace

void keep_image(CellResult& cell, const SpectralImage& image, double exposure_ev) {
    fs::create_directories(cell.folder);
    write_spectral_exr(cell.folder / "image.exr", image, exposure_ev);
    DisplayOptions display;
    display.exposure_ev = exposure_ev;
    write_display_png(cell.folder / "image.png", image, display);
    cell.has_image = true;
}

Json measurement_json(const CellMeasurement& measurement) {
    Json json = {{"bands",
                  {{"from_nm", measurement.bands.from_nm},
                   {"step_nm", measurement.bands.step_nm},
                   {"count", measurement.bands.count}}},
                 {"colours", Json::array()},
                 {"matrix", list_json(measurement.matrix.reshaped())}, // column after column
                 {"specular", list_json(measurement.specular)},
                 {"polar", Json::array()},
                 {"notes", measurement.notes}};
    if (measurement.of_sheet()) {
        json["transmitted"] = list_json(measurement.transmitted.reshaped());
        json["guided"] = list_json(measurement.guided.reshaped());
        json["straight"] = list_json(measurement.straight);
    }
    for (const SeenColour& colour : measurement.colours)
        json["colours"].push_back(colour_json(colour));
    for (const PolarCurve& curve : measurement.polar)
        json["polar"].push_back({{"theta_i_deg", curve.theta_i_deg},
                                 {"angle_deg", list_json(curve.angle_deg)},
                                 {"diffuse", list_json(curve.diffuse)},
                                 {"total", list_json(curve.total)}});
    return json;
}

void keep_cell(const CellResult& cell, const std::string& identity) {
    fs::create_directories(cell.folder);
    Json json = {{"identity", identity},
                 {"labels", cell.labels},
                 {"has_image", cell.has_image},
                 {"relmse", finite_or_null(cell.relmse)}};
    if (cell.measurement) {
        keep_plots(cell, *cell.measurement);
        json["measurement"] = measurement_json(*cell.measurement);
    }
    write_json(cell.folder / "cell.json", json);
}

bool restore_cell(CellResult& cell, const std::string& identity) {
    std::ifstream stream = open_regular_file(cell.folder / "cell.json");
    const Json json = Json::parse(stream, nullptr, false);
    CellResult restored = cell;
    try {
        if (!json.is_object() || json.at("identity") != identity)
            return false;
        restored.kept = true;
        restored.has_image = json.at("has_image").get<bool>();
        restored.relmse = number_from(json.at("relmse"));
        if (json.contains("measurement"))
            restored.measurement = measurement_from(json.at("measurement"));
        if (restored.has_image)
            read_spectral_exr(cell.folder / "image.exr"); // throws unless it is whole
        std::error_code ignored;
        if (restored.has_image && !fs::exists(cell.folder / "image.png", ignored))
            return false;
    } catch (const Json::exception&) {
        return false;
    } catch (const Error&) {
        return false;
    }
    cell = std::move(restored);
    return true;
}

std::string cells_text(const std::vector<CellResult>& cells) {
    Json list = Json::array();
    for (const CellResult& cell : cells)
        list.push_back({cell.index, cell.identity, cell.error, cell.kept});
    return list.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<ToldCell> told_cells(const std::string& text) {
    std::vector<ToldCell> cells;
    for (const Json& cell : Json::parse(text))
        cells.push_back({cell.at(0).get<std::size_t>(), cell.at(1).get<std::string>(),
                         cell.at(2).get<std::string>(), cell.at(3).get<bool>()});
    return cells;
}

std::string matrix_svg(const WavelengthGrid& bands, const Eigen::MatrixXd& matrix) {
    const std::vector<double> nm = bands.centres_nm();
    return svg::heat_map({"Re-radiation, square root", "excitation, nm", "emission, nm", nm, nm,
                          matrix.cwiseSqrt(), false});
}

std::string polar_svg(const PolarCurve& curve, const std::string& illuminant) {
    return svg::polar_plot(fmt::format("Luminance factor under {}", illuminant),
                           {{"total", curve.angle_deg, curve.total},
                            {"through slabs and substrate", curve.angle_deg, curve.diffuse}},
                           curve.theta_i_deg);
}

} // namespace reradiant
