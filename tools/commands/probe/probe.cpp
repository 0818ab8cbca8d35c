#include "tools/commands/probe/probed_places.h"

#include "host/base/atomic_file.h"
#include "host/report/json_file.h"
#include "reradiant/error.h"
#include "tools/commands/probe/probe_places.h"
#include "tools/program/command.h"
#include "tools/program/display_options.h"
#include "tools/program/groups_option.h"
#include "tools/program/outputs.h"

#include <fmt/core.h>

#include <memory>

namespace reradiant {

namespace {

struct ProbeCommand {
    std::filesystem::path image, csv, plot;
    std::vector<std::string> at, regions;
    std::string lamp = "D65", groups;
    double white_luminance = 1.0;
};

/// Errors of a place name the image.
ProbedImage probe_file(const ProbeCommand& command, const std::vector<ImageRegion>& places,
                       const Xyz& white) {
    const SpectralImage image = read_image(command.image, parse_groups_option(command.groups));
    try {
        return probe(image, places, white);
    } catch (const Error& error) {
        throw_input_error({command.image.string()}, error.what());
    }
}

int run_probe(const ProbeCommand& command, const CommandContext& context) {
    const std::vector<ImageRegion> places = probe_places(command.at, command.regions);
    const Xyz white = white_of_lamp("--lamp", command.lamp, command.white_luminance);
    check_outputs(context.common,
                  {{"-o", command.csv, {".csv"}}, {"--plot", command.plot, {".svg"}}},
                  {command.image, command.lamp});
    ProbedImage probed = probe_file(command, places, white);
    probed.image = command.image.filename().string();
    probed.lamp = command.lamp;
    if (!command.csv.empty())
        write_text_atomically(command.csv, probe_csv(probed));
    if (!command.plot.empty())
        write_text_atomically(command.plot, probe_plot(probed));
    if (!context.common.json.empty())
        write_json(context.common.json, probe_json(probed));
    fmt::print("{}", probe_text(probed));
    return 0;
}

} // namespace

void add_probe_command(Program& program, CommandContext& context) {
    auto command = std::make_shared<ProbeCommand>();
    Command app = program.add_command(
        "probe", "Reads values off a spectral image: spectrum with its standard error, XYZ, Lab, "
                 "luminance, ratios and CIEDE2000 between places");
    app.option("IMAGE", command->image, "spectral EXR").required();
    app.option("--at", command->at,
               "a pixel X,Y from the upper left, or X,Y:R: those within R pixels of it "
               "(repeatable)")
        .one_at_a_time();
    app.option("--region", command->regions,
               "rectangle X0,Y0,X1,Y1 with both its corners (repeatable)")
        .one_at_a_time();
    add_groups_option(app, command->groups);
    app.option("-o,--output", command->csv, "CSV of spectra, standard errors and ratios");
    app.option("--plot", command->plot, "SVG plot of the spectra with 95 % intervals");
    app.option("--lamp", command->lamp,
               "the light whose white Lab is relative to: a lamp as `colour` takes it, or its file")
        .show_default();
    app.option("--white-luminance", command->white_luminance, "luminance Y of that white")
        .positive()
        .show_default();
    app.footer("Example: reradiant probe out.exr --at 40,30:3 --at 90,30:3 -o spectra.csv --plot "
               "spectra.svg");
    app.callback([command, &context] { context.exit_code = run_probe(*command, context); });
}

} // namespace reradiant
