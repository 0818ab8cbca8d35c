#include "host/base/atomic_file.h"
#include "host/base/logging.h"
#include "host/report/json_file.h"
#include "host/report/svg.h"
#include "host/spectral/colour/colour_report.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "reradiant/error.h"
#include "reradiant/spectral_files.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace reradiant {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int exit_no_polygon_passes = 3;

struct ColourOptions {
    fs::path matrix, against, polygons, plot;
    std::vector<std::string> illuminants{"D65"};
    bool e308 = false, plain = false, table = false;

    ColourSum sum() const {
        if (e308)
            return ColourSum::E308;
        return plain ? ColourSum::Bands : ColourSum::Automatic;
    }
};

ColourReport report_of_file(const fs::path& file, const ReradiationMatrix& matrix,
                            const std::string& name, ColourSum sum) {
    Spectrum light;
    try {
        light = illuminant(name);
    } catch (const std::invalid_argument& error) {
        throw_input_error({}, fmt::format("--illuminant: {}", error.what()));
    }
    try {
        return colour_report(matrix, name, light, sum);
    } catch (const std::invalid_argument& error) {
        throw_input_error({file.string()}, fmt::format("under {}, {}", name, error.what()),
                          "a colour needs emission bands in the visible, and light there");
    }
}

/// Refuses polygons that no requested illuminant can test: their verdict would be missed.
std::vector<ColourPolygon> read_polygons(const ColourOptions& options) {
    if (options.polygons.empty())
        return {};
    std::vector<ColourPolygon> polygons = read_colour_polygons(options.polygons);
    for (const ColourPolygon& polygon : polygons)
        if (std::find(options.illuminants.begin(), options.illuminants.end(), polygon.illuminant) ==
            options.illuminants.end())
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

std::vector<SeenPair> report_colours(const ColourOptions& options,
                                     const ReradiationMatrix& matrix) {
    const ColourSum sum = options.sum();
    const std::vector<ColourPolygon> polygons = read_polygons(options);
    std::optional<ReradiationMatrix> other;
    if (!options.against.empty()) {
        other = read_reradiation(options.against);
        warn_of_matrix(options.against.string(), *other);
    }
    std::vector<SeenPair> seen;
    for (const std::string& name : options.illuminants) {
        ColourReport report = report_of_file(options.matrix, matrix, name, sum);
        std::optional<ColourReport> against;
        if (other) {
            against = report_of_file(options.against, *other, name, sum);
            report.ciede2000 = ciede2000(report.colour.lab, against->colour.lab);
        }
        for (const ColourPolygon& polygon : polygons)
            if (polygon.illuminant == name)
                report.polygons.push_back({polygon, test_polygon(polygon, report.colour)});
        seen.push_back({std::move(report), std::move(against)});
    }
    return seen;
}

void print_polygons(const ColourReport& report) {
    for (const PolygonVerdict& verdict : report.polygons)
        fmt::print("  {}: {} (chromaticity {}, luminance factor {:.4f} {} {})\n",
                   verdict.polygon.name, verdict.result.passes() ? "passes" : "fails",
                   verdict.result.chromaticity ? "inside" : "outside", report.colour.xyz[1] / 100.0,
                   verdict.result.luminance_factor ? "of at least" : "is under",
                   verdict.polygon.minimum_luminance_factor);
}

/// Radiance factors: total = reflected + luminescent.
void print_table(const MatrixColour& colour) {
    fmt::print("  {:>7} {:>9} {:>9} {:>9}\n", "nm", "beta_T", "beta_R", "beta_L");
    for (std::size_t o = 0; o < colour.nm.size(); ++o)
        fmt::print("  {:>7.6g} {:>9.5f} {:>9.5f} {:>9.5f}\n", colour.nm[o], colour.total[o],
                   colour.reflected[o], colour.luminescent[o]);
}

void print(const ColourReport& report, const ColourOptions& options) {
    const MatrixColour& colour = report.colour;
    const std::size_t brightest = report.brightest_band();
    fmt::print("{}\n", report.illuminant);
    if (!colour.reason.empty())
        fmt::print("  {}\n", colour.reason);
    fmt::print("  XYZ  {:.4f} {:.4f} {:.4f}\n", colour.xyz[0], colour.xyz[1], colour.xyz[2]);
    fmt::print("  xy   {:.5f} {:.5f}\n", colour.xy[0], colour.xy[1]);
    fmt::print("  Lab  {:.4f} {:.4f} {:.4f}\n", colour.lab[0], colour.lab[1], colour.lab[2]);
    fmt::print("  luminance factor {:.4f} = {:.4f} reflected + {:.4f} re-radiated\n",
               colour.xyz[1] / 100.0, colour.luminance_reflected / 100.0,
               (colour.xyz[1] - colour.luminance_reflected) / 100.0);
    fmt::print("  largest total radiance factor {:.4f} at {:.6g} nm\n", colour.total[brightest],
               colour.nm[brightest]);
    if (report.whiteness)
        fmt::print("  whiteness {:.2f}, tint {:.2f}{}\n", report.whiteness->whiteness,
                   report.whiteness->tint,
                   report.whiteness->within_limits ? "" : " (no white: outside the limits)");
    if (report.ciede2000)
        fmt::print("  CIEDE2000 {:.4f} from {}\n", *report.ciede2000, options.against.string());
    print_polygons(report);
    if (options.table)
        print_table(colour);
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

void write_plot(const ColourOptions& options, const std::vector<SeenPair>& seen) {
    if (options.plot.empty())
        return;
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

/// The names between commas; one that is empty is a slip.
std::vector<std::string> split_names(const std::vector<std::string>& given) {
    std::vector<std::string> names;
    for (const std::string& list : given) {
        std::istringstream parts(list + ',');
        for (std::string name; std::getline(parts, name, ',');) {
            if (name.empty())
                throw_input_error({}, fmt::format("--illuminant: a name is missing in '{}'", list),
                                  "write names between commas, as in D65,A");
            names.push_back(name);
        }
    }
    return names;
}

int run_colour(ColourOptions options, const CommonOptions& common) {
    options.illuminants = split_names(options.illuminants);
    check_outputs(common, {{"--plot", options.plot, {".svg"}}},
                  {options.matrix, options.against, options.polygons});
    const ReradiationMatrix matrix = read_reradiation(options.matrix);
    warn_of_matrix(options.matrix.string(), matrix);
    const std::vector<SeenPair> seen = report_colours(options, matrix);
    Json json = Json::object();
    for (const SeenPair& pair : seen) {
        const ColourReport& report = pair.report;
        json[report.illuminant] = colour_report_json(report);
        for (const std::string& warning : report.warnings)
            logging::warn("{}: {}", options.matrix.string(), warning);
        print(report, options);
    }
    write_plot(options, seen);
    write_json(common.json, json);
    if (options.polygons.empty() || some_polygon_passes(seen))
        return 0;
    fmt::print(stderr, "{}: the colour passes none of the polygons of {}\n",
               options.matrix.string(), options.polygons.string());
    return exit_no_polygon_passes;
}

} // namespace

void add_colour_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<ColourOptions>();
    Command command = program.add_command(
        "colour", "Colour of a re-radiation matrix: XYZ, xy, Lab, whiteness, radiance factors");
    command.option("MATRIX", options->matrix, "re-radiation matrix (.csv, .bfc, .exr)").required();
    command
        .option("--illuminant", options->illuminants,
                "CIE illuminants: D65,A,FL2,LED-B3; an unknown name lists them all")
        .show_default();
    const CommandOption e308 = command.flag(
        "--e308", options->e308,
        "sums over 1 nm between the bands (ASTM E308, E2022), for every lamp; by default they are "
        "plain sums at the bands (ASTM E2152) unless these misjudge the lamp itself by over 0.2 %");
    command.flag("--plain-sums", options->plain, "plain sums at the bands, for every lamp")
        .excludes(e308);
    command.option("--against", options->against,
                   "CIEDE2000 to the colour of this matrix, under each illuminant");
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
