#include "host/base/atomic_file.h"
#include "host/base/logging.h"
#include "host/report/json_file.h"
#include "host/spectral/colour/colour_report.h"
#include "tools/commands/colour/colour_options.h"
#include "tools/commands/colour/colour_page.h"
#include "tools/commands/colour/colour_plot.h"
#include "tools/commands/colour/colour_print.h"
#include "tools/commands/colour/colour_table.h"
#include "tools/commands/colour/covariance_options.h"
#include "tools/commands/colour/seen_colours.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace reradiant {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int exit_no_polygon_passes = 3;

/// Logs each sentence once for a sample.
void log_warnings(const SeenSample& sample) {
    for (const std::string& warning : warnings_of(sample))
        logging::warn("{}: {}", sample.sample.file.string(), warning);
}

/// One sample says all, several a row each. --table asks for all of every sample.
void print_samples(const std::vector<SeenSample>& samples, const ColourOptions& options) {
    if (samples.size() > 1 && !options.table) {
        fmt::print("{}", aligned(short_table(samples, options)));
        return;
    }
    for (const SeenSample& sample : samples) {
        if (samples.size() > 1)
            fmt::print("# {}\n", sample.sample.name);
        for (const SeenColour& seen : sample.colours)
            print_colour(seen.report, options);
    }
}

/// The reports of one sample by their keys; of several, these by the samples' names.
Json samples_json(const std::vector<SeenSample>& samples, const ColourOptions& options) {
    Json all = Json::object();
    for (const SeenSample& sample : samples) {
        Json json = Json::object();
        for (const SeenColour& seen : sample.colours)
            json[key_of(seen.report, options)] = colour_report_json(seen.report);
        if (samples.size() == 1)
            return json;
        all[sample.sample.name] = std::move(json);
    }
    return all;
}

void write_files(const std::vector<SeenSample>& samples, const ColourOptions& options,
                 const CommonOptions& common) {
    if (!options.plot.empty())
        write_text_atomically(options.plot, samples.size() == 1
                                                ? factors_plot(samples.front(), options)
                                                : totals_plot(samples, options));
    if (!options.csv.empty())
        write_csv(options.csv, whole_table(samples, options));
    if (!options.report.empty())
        write_text_atomically(options.report, colour_page(samples, options));
    if (!common.json.empty())
        write_json(common.json, samples_json(samples, options));
}

/// 0, or 3 where a sample passes none of the polygons, which is said of each.
int polygon_verdict(const std::vector<SeenSample>& samples, const ColourOptions& options) {
    int exit_code = 0;
    for (const SeenSample& sample : samples) {
        if (options.polygons.empty() || sample.passes_a_polygon())
            continue;
        fmt::print(stderr, "{}: the colour passes none of the polygons of {}\n",
                   sample.sample.file.string(), options.polygons.string());
        exit_code = exit_no_polygon_passes;
    }
    return exit_code;
}

int run_colour(ColourOptions options, const CommonOptions& common) {
    read_conditions(options);
    options.seed = common.seed;
    std::vector<fs::path> inputs = sample_files(options);
    inputs.insert(inputs.end(), options.lamp_files.begin(), options.lamp_files.end());
    inputs.insert(inputs.end(),
                  {options.against, options.polygons, options.covariance, options.standard_errors});
    check_outputs(common,
                  {{"--plot", options.plot, {".svg"}},
                   {"--csv", options.csv, {".csv"}},
                   {"--report", options.report, {".html", ".htm"}}},
                  inputs);
    std::vector<SeenSample> samples = see_samples(options);
    add_intervals(options, samples);
    for (const SeenSample& sample : samples)
        log_warnings(sample);
    print_samples(samples, options);
    write_files(samples, options, common);
    return polygon_verdict(samples, options);
}

void add_lamp_options(Command& command, ColourOptions& options) {
    command
        .option("--illuminant", options.illuminants,
                "lamps between commas (D65 where none is given): CIE illuminants such as "
                "D65,A,FL2,LED-B3, D:KELVIN (CIE daylight), P:KELVIN (black body), "
                "L:NM[:WIDTH] (line), sums such as D65+30*L:365, M0, M1, M2 (ISO 13655); an "
                "unknown name lists them all")
        .one_at_a_time();
    command
        .option(
            "--lamp", options.lamp_files,
            "file of a lamp's spectrum, or LAMP.toml with spectrum = SPECTRUM as in scenes, a lamp "
            "behind a filter, say (repeatable); outside its data it is dark")
        .one_at_a_time();
    command.option("--uv-cut", options.uv_cut_nm,
                   "take the lamps away below this wavelength in nm");
    command
        .option("--observer", options.observer_names,
                "1931-2, 1964-10, 2015-2, 2015-10, or several between commas")
        .one_at_a_time()
        .show_default();
}

void add_output_options(Command& command, ColourOptions& options) {
    command.flag("--table", options.table,
                 "print the radiance factors at every wavelength, too: total, reflected, "
                 "luminescent (the JSON has them anyway)");
    command.option("--plot", options.plot,
                   "write the radiance factors as an SVG plot, with --against of both; of several "
                   "samples the totals");
    command.option("--csv", options.csv,
                   "write a table of all colours and indices: a row for each sample, lamp and "
                   "observer");
    command.option("--report", options.report,
                   "write a page: swatches, indices, chromaticity diagram, radiance factors");
}

} // namespace

void add_colour_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<ColourOptions>();
    Command command = program.add_command(
        "colour", "Colours of re-radiation matrices and layered materials: XYZ, Lab, indices of "
                  "white and yellow, radiance factors");
    command.option("SAMPLE", options->samples,
                   "re-radiation matrix (.csv, .bfc, .exr), material (.toml) or what `measure` "
                   "wrote (.csv); several make a table");
    command
        .option("--preset", options->presets,
                "a material that is shipped, by its name (repeatable)")
        .one_at_a_time();
    command.option("--geometry", options->geometry,
                   "of materials: 45/0 (where none is given), 0/45, 8/d, d/8 (specular included), "
                   "8/de, de/8 (excluded), or THETA_I:THETA_O[:PHI] in degrees; of files of "
                   "`measure` one that they hold");
    add_lamp_options(command, *options);
    const CommandOption e308 = command.flag(
        "--e308", options->e308,
        "sums over 1 nm between the bands (ASTM E308, E2022), for every lamp; by default they are "
        "plain sums at the bands (ASTM E2152) unless these misjudge the lamp itself by over 0.2 %");
    command.flag("--plain-sums", options->plain, "plain sums at the bands, for every lamp")
        .excludes(e308);
    command.option("--against", options->against,
                   "differences from the colour of this sample, under each lamp");
    add_covariance_options(command, *options);
    command.option("--polygons", options->polygons,
                   "CSV of chromaticity regions and luminance factors to test against, for "
                   "instance spectra/polygons/en-iso-20471.csv; exit with 3 when a sample passes "
                   "none");
    add_output_options(command, *options);
    command.footer("Examples:\n"
                   "  reradiant colour paint.bfc --illuminant D65,A --json colour.json\n"
                   "  reradiant colour vest.csv --polygons spectra/polygons/en-iso-20471.csv\n"
                   "  reradiant colour fit.csv --against data.csv --plot factors.svg\n"
                   "  reradiant colour a.csv b.bfc varnished.toml --csv colours.csv --report "
                   "colours.html");
    command.callback(
        [options, &context] { context.exit_code = run_colour(*options, context.common); });
}

} // namespace reradiant
