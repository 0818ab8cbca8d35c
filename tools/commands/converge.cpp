#include "host/study/converge/converge.h"
#include "host/film/display/display_picture.h"
#include "host/render/wavefront/render_hooks.h"
#include "host/report/json_file.h"
#include "host/report/progress.h"
#include "host/study/converge/converge_page.h"
#include "host/study/converge/converge_store.h"
#include "reradiant/error.h"
#include "reradiant/scene_file.h"
#include "tools/program/command.h"
#include "tools/program/interrupt.h"
#include "tools/program/join_team.h"
#include "tools/program/outputs.h"
#include "tools/program/parse_options.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <memory>

namespace reradiant {

namespace {

struct ConvergeCommand {
    std::filesystem::path scene;
    ConvergeOptions options;
    std::string methods = "auto,auto+comb:16,weidlich-wilkie", bands;
};

/// Prints the time that the run will take at most: methods and references of an earlier run are
/// kept.
void print_plan(const ConvergeOptions& options) {
    const double methods = options.time_seconds * static_cast<double>(options.methods.size());
    const std::string of_methods =
        fmt::format("{} method{} of {:g} s", options.methods.size(),
                    options.methods.size() == 1 ? "" : "s", options.time_seconds);
    if (!options.reference.empty())
        fmt::print("{}: about {}\n", of_methods, duration_text(methods));
    else if (options.reference_samples > 0)
        fmt::print("a reference of {} samples a pixel, then {}\n", options.reference_samples,
                   of_methods);
    else
        fmt::print("a reference of {}, then {}: about {} and the set-up; --reference FILE or "
                   "--spp-reference N make it less\n",
                   duration_text(reference_seconds(options)), of_methods,
                   duration_text(reference_seconds(options) + methods));
    std::fflush(stdout);
}

void print_summary(const ConvergeResult& result, const std::filesystem::path& folder) {
    for (const MethodResult& method : result.methods) {
        const ErrorCurve& curve = method.curve;
        const CurveRow& last = curve.rows.back();
        const BiasFloor floor = bias_floor(curve, result.reference.estimate);
        const double slope = slope_over_samples(curve); // not known of one row
        fmt::print("{}: relMSE {:.3g} after {:.3g} s ({} samples a pixel){}, 1 / (relMSE x "
                   "seconds) {:.3g}{}{}\n",
                   curve.method.name, last.error.relmse, last.seconds, last.samples,
                   std::isfinite(slope) ? fmt::format(", RMSE falls as samples^{:.3f}", slope) : "",
                   efficiency(curve),
                   floor.relmse > 0.0
                       ? fmt::format(", its own bias keeps relMSE above {:.3g}", floor.relmse)
                       : "",
                   method.resumed ? " (kept from an earlier run)" : "");
    }
    fmt::print("{}\n", result.interrupted ? "interrupted: run again to go on"
                                          : (folder / "index.html").string());
}

int run_converge(ConvergeCommand command, const CommandContext& context) {
    CommonOptions common = context.common;
    const std::unique_ptr<Team> team = join_team(common);
    ConvergeOptions& options = command.options;
    options.methods = parse_methods(command.methods);
    if (!command.bands.empty())
        options.render.bands = parse_bands_option(command.bands);
    options.render.seed = common.seed;
    options.render.threads = common.threads;
    options.render.processes_on_machine = members_on_host(team);
    options.team = team.get();
    options.folder = output_directory(options.folder);
    check_outputs(common, {}, {command.scene, options.reference}, options.folder);
    check_display({});
    const Scene scene = load_scene(command.scene);
    team ? catch_interrupts() : end_at_interrupts();
    prepare_opencl(common.threads);
    const Device device(common.device);
    const RenderHooks hooks{.on_set_up = catch_interrupts};
    options.render.hooks = &hooks;
    if (!common.quiet && (!team || team->leads()))
        print_plan(options);
    ConvergeResult result;
    {
        ProgressBar bar(common.quiet);
        bar.update("setting up tables and kernels");
        result = converge(scene, device, options, [&](double share, const std::string& note) {
            bar.update(share, note);
            return !interrupt_requested();
        });
    }
    if (team && !team->leads())
        return 0;
    if (!result.methods.empty()) {
        const auto json = converge_json(result, scene, device, options.time_seconds);
        write_curves_csv(options.folder / "curve.csv", result);
        write_json(options.folder / "curve.json", json);
        write_json(common.json, json);
        write_converge_page(options.folder, result, scene, device);
    }
    if (!common.quiet)
        print_summary(result, options.folder);
    return result.interrupted ? exit_interrupted : 0;
}

} // namespace

void add_converge_command(Program& program, CommandContext& context) {
    auto command = std::make_shared<ConvergeCommand>();
    Command app = program.add_command(
        "converge", "Measures error against run time: CSV, JSON, plots and a page");
    app.option("SCENE", command->scene, "scene file (TOML, or XML of Mitsuba 3)").required();
    app.option("-o,--output", command->options.folder, "folder to write to").required();
    app.option(
           "--methods", command->methods,
           "separated by commas: a model of `render` (auto, adding, weidlich-wilkie, walk), its "
           "wavelengths (comb, comb:N, hero, hero:N), adaptive, or several in one as "
           "adding+comb:16+adaptive or hero:8+adaptive")
        .show_default();
    app.option("--reference", command->options.reference,
               "spectral EXR to compare with; default: one is rendered");
    app.option("--spp-reference", command->options.reference_samples,
               "samples a pixel of the reference that is rendered; default: as many as ten "
               "times --time allow")
        .in_range(1u, 1u << 30);
    app.option("--time", command->options.time_seconds, "seconds of rendering, each method")
        .positive()
        .show_default();
    app.option("--bands", command->bands, "film bands in nm, FROM:TO:STEP");
    app.option("--memory-limit", command->options.render.memory_limit_bytes,
               "refuse a render that would take more bytes (default: 80 % of the machine's)");
    app.option("--checkpoint", command->options.render.checkpoint_seconds,
               "keep the render in progress every so many seconds")
        .positive()
        .show_default();
    app.flag("--resume", command->options.resume,
             "refuse what was kept of another scene, build or device; without it such a render "
             "begins anew");
    app.footer("Example: reradiant converge scene.toml -o errors --methods adding,adding+comb:16 "
               "--time 20");
    app.callback([command, &context] { context.exit_code = run_converge(*command, context); });
}

} // namespace reradiant
