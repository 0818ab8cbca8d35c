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
#include <set>

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
            number_from(json.at("quantum_yield"))};
}

CellMeasurement measurement_from(const Json& json) {
    CellMeasurement measurement;
    const Json& bands = json.at("bands");
    measurement.bands = {bands.at("from_nm").get<double>(), bands.at("step_nm").get<double>(),
                         whole_number<int>(bands.at("count"))};
    const int n = measurement.bands.count;
    const std::vector<double> entries = list_from(json.at("matrix"));
    if (n < 1 || entries.size() != static_cast<std::size_t>(n) * static_cast<std::size_t>(n))
        throw_runtime_error("the cell's matrix has another size than its bands");
    measurement.matrix = Eigen::Map<const Eigen::MatrixXd>(entries.data(), n, n);
    measurement.specular = list_from(json.at("specular"));
    for (const Json& colour : json.at("colours"))
        measurement.colours.push_back(colour_from(colour));
    for (const Json& curve : json.at("polar"))
        measurement.polar.push_back({curve.at("theta_i_deg").get<double>(),
                                     list_from(curve.at("angle_deg")),
                                     list_from(curve.at("diffuse")), list_from(curve.at("total"))});
    measurement.notes = json.at("notes").get<std::vector<std::string>>();
    return measurement;
}

void keep_plots(const CellResult& cell, const CellMeasurement& measurement) {
    ReradiationMatrix matrix;
    matrix.emission = matrix.excitation = measurement.bands;
    matrix.values = measurement.matrix;
    matrix.geometry = fmt::format("{:g}/hemispherical", measurement.colours.front().theta_i_deg);
    write_reradiation(cell.folder / "matrix.csv", matrix);
    write_text_atomically(cell.folder / "matrix.svg", matrix_svg(measurement));
    for (const PolarCurve& curve : measurement.polar)
        write_text_atomically(cell.folder / fmt::format("polar-{:g}.svg", curve.theta_i_deg),
                              polar_svg(curve, measurement.colours.front().illuminant));
}

/// A text as a field of a CSV: quoted where it holds a comma, a quote or a line's end.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char character : text)
        quoted += character == '"' ? std::string("\"\"") : std::string(1, character);
    return quoted + "\"";
}

/// Nothing stands for what is not known.
std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{:.9g}", value) : "";
}

/// Bands of all measurements: a swept matrix may bring its own.
std::set<double> all_bands_nm(const StudyResult& result) {
    std::set<double> all;
    for (const CellResult& cell : result.cells)
        if (cell.measurement)
            for (const double nm : cell.measurement->bands.centres_nm())
                all.insert(nm);
    return all;
}

std::string colour_fields(const SeenColour& colour, const WavelengthGrid& bands,
                          const std::set<double>& columns_nm) {
    std::string text = csv_field(colour.illuminant);
    for (const double value :
         {colour.theta_i_deg, colour.theta_o_deg, colour.phi_deg, colour.xyz[0], colour.xyz[1],
          colour.xyz[2], colour.lab[0], colour.lab[1], colour.lab[2], colour.quantum_yield})
        text += fmt::format(",{}", csv_number(value));
    const std::vector<double> centres = bands.centres_nm();
    for (const double nm : columns_nm) {
        const auto place = std::find(centres.begin(), centres.end(), nm);
        text += ",";
        if (place != centres.end())
            text += csv_number(colour.beta_t[static_cast<std::size_t>(place - centres.begin())]);
    }
    return text;
}

/// Mean of an image; white is D65 with Y = 1, shown as 100.
std::string image_fields(const CellResult& cell) {
    const std::vector<Xyz> pixels = xyz_image(read_spectral_exr(cell.folder / "image.exr"));
    Xyz mean{}, white = xyz_of(illuminant_with_luminance("D65", 100.0));
    for (const Xyz& pixel : pixels)
        for (std::size_t channel = 0; channel < 3; ++channel)
            mean[channel] += 100.0 * pixel[channel] / static_cast<double>(pixels.size());
    const auto lab = xyz_to_lab(mean, white);
    return fmt::format(",,,,{},{},{},{},{},{},", csv_number(mean[0]), csv_number(mean[1]),
                       csv_number(mean[2]), csv_number(lab[0]), csv_number(lab[1]),
                       csv_number(lab[2]));
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

std::string matrix_svg(const CellMeasurement& measurement) {
    const std::vector<double> nm = measurement.bands.centres_nm();
    return svg::heat_map({"Re-radiation, square root", "excitation, nm", "emission, nm", nm, nm,
                          measurement.matrix.cwiseSqrt(), false});
}

std::string polar_svg(const PolarCurve& curve, const std::string& illuminant) {
    return svg::polar_plot(fmt::format("Luminance factor under {}", illuminant),
                           {{"total", curve.angle_deg, curve.total},
                            {"through the substrate", curve.angle_deg, curve.diffuse}},
                           curve.theta_i_deg);
}

void write_study_table(const fs::path& file, const Study& study, const StudyResult& result) {
    std::string head = "cell";
    for (const Sweep& sweep : study.sweeps)
        head += fmt::format(",{}", csv_field(sweep.label));
    head += ",source,illuminant,theta_i_deg,theta_o_deg,phi_deg,X,Y,Z,L,a,b,quantum_yield";
    const std::set<double> columns_nm = all_bands_nm(result);
    for (const double nm : columns_nm)
        head += fmt::format(",beta_T_{:g}nm", nm);
    std::string rows;
    for (const CellResult& cell : result.cells) {
        std::string front = std::to_string(cell.index);
        for (const std::string& label : cell.labels)
            front += fmt::format(",{}", csv_field(label));
        if (cell.has_image && !cell.failed())
            rows += fmt::format("{},rendered,{}\n", front,
                                image_fields(cell) + std::string(columns_nm.size(), ','));
        if (!cell.measurement)
            continue;
        for (const SeenColour& colour : cell.measurement->colours)
            rows += fmt::format("{},measured,{}\n", front,
                                colour_fields(colour, cell.measurement->bands, columns_nm));
    }
    write_text_atomically(file, head + "\n" + rows);
}

} // namespace reradiant
