#include "host/base/atomic_file.h"
#include "host/base/logging.h"
#include "host/measure/geometry_matrix.h"
#include "host/report/json_file.h"
#include "host/report/svg.h"
#include "host/spectral/colour/colour_report.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "reradiant/error.h"
#include "reradiant/scene_file.h"
#include "reradiant/spectral_files.h"
#include "tools/commands/colour/colour_options.h"
#include "tools/commands/colour/colour_print.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"
#include "tools/program/parse_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>

namespace reradiant {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int exit_no_polygon_passes = 3;

ColourReport report_of_file(const fs::path& file, const ReradiationMatrix& matrix, const Lamp& lamp,
                            Observer observer, ColourSum sum) {
    try {
        return colour_report(matrix, lamp, sum, observer);
    } catch (const std::invalid_argument& error) {
        throw_input_error({file.string()}, fmt::format("under {}, {}", lamp.name, error.what()),
                          "a colour needs emission bands in the visible, and light there");
    }
}

bool is_material(const fs::path& file) {
    return file.extension() == ".toml";
}

/// A preset is the file of its name.
void find_sample(ColourOptions& options) {
    if (options.preset.empty() == options.matrix.empty())
        throw_input_error({}, "colour needs a MATRIX, a MATERIAL.toml or a --preset",
                          "give one of them");
    if (!options.preset.empty())
        options.matrix = preset_file(options.preset);
    if (!options.geometry.empty() && !is_material(options.matrix))
        throw_input_error({options.matrix.string()},
                          "the geometry of a matrix is that of the instrument that measured it",
                          "--geometry is for materials (.toml, --preset)");
}

/// A matrix, or the radiance factors of a material in the geometry that is asked for.
ReradiationMatrix read_sample(const fs::path& file, const ColourOptions& options) {
    if (!is_material(file)) {
        const ReradiationMatrix matrix = read_reradiation(file);
        warn_of_matrix(file.string(), matrix);
        return matrix;
    }
    ViewingGeometry geometry;
    try {
        if (!options.geometry.empty())
            geometry = viewing_geometry(options.geometry);
    } catch (const std::invalid_argument& error) {
        throw_input_error({}, fmt::format("--geometry: {}", error.what()));
    }
    const Material material = load_material(file);
    try {
        return geometry_matrix(material, geometry);
    } catch (const Error& error) {
        if (error.kind() == Error::Kind::Input && error.position().file.empty())
            throw_input_error({file.string()}, error.what());
        throw;
    }
}

/// Refuses polygons that no requested illuminant can test: their verdict would be missed.
std::vector<ColourPolygon> read_polygons(const ColourOptions& options) {
    if (options.polygons.empty())
        return {};
    std::vector<ColourPolygon> polygons = read_colour_polygons(options.polygons);
    for (const ColourPolygon& polygon : polygons)
        if (std::none_of(options.lamps.begin(), options.lamps.end(),
                         [&](const Lamp& lamp) { return lamp.name == polygon.illuminant; }))
            throw_input_error(
                {options.polygons.string(), polygon.line, 1},
                fmt::format("'{}' is tested under {}", polygon.name, polygon.illuminant),
                fmt::format("add {} to --illuminant", polygon.illuminant));
    return polygons;
}

/// The colour of the matrix under one lamp, and that of the matrix that it is compared with.
struct SeenPair {
    ColourReport report;
    std::optional<ColourReport> against;
};

void set_metamerism(SeenPair& test, const SeenPair& reference) {
    test.report.metamerism = metamerism_index(reference.against->colour, reference.report.colour,
                                              test.against->colour, test.report.colour);
}

std::vector<SeenPair> report_colours(const ColourOptions& options,
                                     const ReradiationMatrix& matrix) {
    const ColourSum sum = options.sum();
    const std::vector<ColourPolygon> polygons = read_polygons(options);
    std::optional<ReradiationMatrix> other;
    if (!options.against.empty())
        other = read_sample(options.against, options);
    std::vector<SeenPair> seen;
    for (const Observer observer : options.observers) {
        const std::size_t first = seen.size();
        for (const Lamp& lamp : options.lamps) {
            ColourReport report = report_of_file(options.matrix, matrix, lamp, observer, sum);
            std::optional<ColourReport> against;
            if (other) {
                against = report_of_file(options.against, *other, lamp, observer, sum);
                compare_with(report, *against);
            }
            if (observer == Observer::Cie1931Deg2) // the diagram that polygons are drawn in
                for (const ColourPolygon& polygon : polygons)
                    if (polygon.illuminant == lamp.name)
                        report.polygons.push_back({polygon, test_polygon(polygon, report.colour)});
            seen.push_back({std::move(report), std::move(against)});
            if (other && seen.size() > first + 1)
                set_metamerism(seen.back(), seen[first]);
        }
    }
    return seen;
}

/// `suffix` names the file where two are drawn.
void add_curves(std::vector<svg::Series>& series, const ColourReport& report, bool reflected,
                const std::string& suffix) {
    const MatrixColour& colour = report.colour;
    series.push_back({report.illuminant + " total" + suffix, colour.nm, colour.total});
    series.push_back({report.illuminant + " luminescent" + suffix, colour.nm, colour.luminescent});
    if (reflected) // drawn once: it is the same under every lamp
        series.push_back({"reflected" + suffix, colour.nm, colour.reflected});
}

/// Radiance factors are the same for every observer: those of the first are drawn.
void write_plot(const ColourOptions& options, std::vector<SeenPair> seen) {
    if (options.plot.empty())
        return;
    seen.resize(options.lamps.size());
    const std::string name = options.matrix.filename().string();
    const std::string other = options.against.filename().string();
    const bool both = !other.empty();
    std::vector<svg::Series> series;
    for (const SeenPair& pair : seen)
        add_curves(series, pair.report, &pair == &seen.back(), both ? ", " + name : "");
    for (const SeenPair& pair : seen)
        if (pair.against)
            add_curves(series, *pair.against, &pair == &seen.back(), ", " + other);
    const svg::Axes axes{.title = both ? name + " and " + other : name,
                         .x_label = "wavelength / nm",
                         .y_label = "radiance factor"};
    write_text_atomically(options.plot, svg::line_plot(axes, series));
}

bool some_polygon_passes(const std::vector<SeenPair>& seen) {
    return std::any_of(seen.begin(), seen.end(), [](const SeenPair& pair) {
        const auto& polygons = pair.report.polygons;
        return std::any_of(polygons.begin(), polygons.end(),
                           [](const PolygonVerdict& verdict) { return verdict.result.passes(); });
    });
}

int run_colour(ColourOptions options, const CommonOptions& common) {
    read_conditions(options);
    find_sample(options);
    std::vector<fs::path> inputs = options.lamp_files;
    inputs.insert(inputs.end(), {options.matrix, options.against, options.polygons});
    check_outputs(common, {{"--plot", options.plot, {".svg"}}}, inputs);
    const ReradiationMatrix matrix = read_sample(options.matrix, options);
    const std::vector<SeenPair> seen = report_colours(options, matrix);
    Json json = Json::object();
    for (const SeenPair& pair : seen) {
        const ColourReport& report = pair.report;
        json[key_of(report, options)] = colour_report_json(report);
        for (const std::string& warning : report.warnings)
            logging::warn("{}: {}", options.matrix.string(), warning);
        print_colour(report, options);
    }
    write_plot(options, seen);
    write_json(common.json, json);
    if (options.polygons.empty() || some_polygon_passes(seen))
        return 0;
    fmt::print(stderr, "{}: the colour passes none of the polygons of {}\n",
               options.matrix.string(), options.polygons.string());
    return exit_no_polygon_passes;
}

void add_lamp_options(Command& command, ColourOptions& options) {
    command.option("--illuminant", options.illuminants,
                   "lamps between commas (D65 where none is given): CIE illuminants such as "
                   "D65,A,FL2,LED-B3, D:KELVIN (CIE daylight), P:KELVIN (black body), "
                   "L:NM[:WIDTH] (line), sums such as D65+30*L:365, M0, M1, M2 (ISO 13655); an "
                   "unknown name lists them all");
    command.option("--lamp", options.lamp_files,
                   "file of a lamp's spectrum (repeatable); outside its data it is dark");
    command.option("--uv-cut", options.uv_cut_nm,
                   "take the lamps away below this wavelength in nm");
    command
        .option("--observer", options.observer_names,
                "1931-2, 1964-10, 2015-2, 2015-10, or several between commas")
        .show_default();
}

} // namespace

void add_colour_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<ColourOptions>();
    Command command = program.add_command(
        "colour", "Colour of a re-radiation matrix or a layered material: XYZ, Lab, indices of "
                  "white and yellow, radiance factors");
    command.option("MATRIX", options->matrix,
                   "re-radiation matrix (.csv, .bfc, .exr) or material (.toml)");
    command.option("--preset", options->preset, "a material that is shipped, by its name");
    command.option("--geometry", options->geometry,
                   "of materials: 45/0 (where none is given), 0/45, 8/d, d/8 (specular included), "
                   "8/de, de/8 (excluded), or THETA_I:THETA_O[:PHI] in degrees");
    add_lamp_options(command, *options);
    const CommandOption e308 = command.flag(
        "--e308", options->e308,
        "sums over 1 nm between the bands (ASTM E308, E2022), for every lamp; by default they are "
        "plain sums at the bands (ASTM E2152) unless these misjudge the lamp itself by over 0.2 %");
    command.flag("--plain-sums", options->plain, "plain sums at the bands, for every lamp")
        .excludes(e308);
    command.option("--against", options->against,
                   "differences from the colour of this matrix, under each lamp");
    command.option("--polygons", options->polygons,
                   "CSV of chromaticity regions and luminance factors to test against, for "
                   "instance spectra/polygons/en-iso-20471.csv; exit with 3 when none passes");
    command.flag("--table", options->table,
                 "print the radiance factors at every wavelength, too: total, reflected, "
                 "luminescent (the JSON has them anyway)");
    command.option("--plot", options->plot,
                   "write the radiance factors as an SVG plot, with --against of both");
    command.footer("Examples:\n"
                   "  reradiant colour paint.bfc --illuminant D65,A --json colour.json\n"
                   "  reradiant colour vest.csv --polygons spectra/polygons/en-iso-20471.csv\n"
                   "  reradiant colour fit.csv --against data.csv --plot factors.svg");
    command.callback(
        [options, &context] { context.exit_code = run_colour(*options, context.common); });
}

} // namespace reradiant
