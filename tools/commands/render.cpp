#include "reradiant/render.h"
#include "host/base/logging.h"
#include "host/device/device_checks.h"
#include "host/film/display/display_picture.h"
#include "host/render/checkpoint/render_identity.h"
#include "host/render/film/render_statistics.h"
#include "host/render/wavefront/render_hooks.h"
#include "host/render/wavefront/team_render.h"
#include "host/report/json_file.h"
#include "host/report/progress.h"
#include "host/scene/model/named_files.h"
#include "reradiant/device.h"
#include "reradiant/error.h"
#include "reradiant/merge.h"
#include "reradiant/scene.h"
#include "reradiant/scene_file.h"
#include "reradiant/spectral_image.h"
#include "tools/program/command.h"
#include "tools/program/display_options.h"
#include "tools/program/interrupt.h"
#include "tools/program/join_team.h"
#include "tools/program/outputs.h"
#include "tools/program/parse_options.h"
#include "tools/program/tev_preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

namespace reradiant {

namespace {

struct RenderCommand {
    std::filesystem::path scene, output, png;
    std::string tev;
    RenderOptions render;
    DisplayTexts display_texts;
    DevelopOptions display;
    std::string model = "auto", wavelengths = "comb", bands, variance, sample_range,
                phase = "random";
    bool samples_given = false;
    std::chrono::steady_clock::time_point begun; ///< of the command, from where --time counts
    std::size_t outside = 0; ///< pixels outside the display's gamut, once it is written

    bool shows_a_display() const {
        return !png.empty() || !display_texts.ocio.empty() || !display_texts.display.empty() ||
               !display_texts.view.empty();
    }
};

void apply_texts(RenderCommand& command, const CommonOptions& common) {
    command.display = parse_display_options(command.display_texts);
    command.render.seed = common.seed;
    command.render.threads = common.threads;
    command.render.model = parse_model_option(command.model);
    command.render.wavelengths = parse_wavelengths_option(command.wavelengths);
    command.render.wavelengths.centred = command.phase == "centre";
    if (command.render.wavelengths.centred && command.render.wavelengths.comb_count > 0)
        throw_input_error({}, "--comb-phase centre needs one wavelength a film band",
                          "leave the count of --wavelengths away");
    command.render.wavelengths.keep_all = command.render.all_features;
    command.render.band_variance = command.variance == "bands";
    check_tev_address(command.tev);
    if (!command.bands.empty())
        command.render.bands = parse_bands_option(command.bands);
    if (!command.sample_range.empty()) {
        const SampleRange range = parse_sample_range_option(command.sample_range);
        if (command.render.adaptive)
            throw_input_error({}, "--adaptive decides itself which samples it takes",
                              "leave --sample-range or --adaptive away");
        command.render.first_sample = range.first;
        command.render.samples = range.end - range.first;
    } else if (!command.samples_given &&
               (std::isfinite(command.render.time_seconds) || command.render.relmse > 0.0)) {
        command.render.samples = 1u << 30; // time or error decide
    }
}

std::string error_text(double relmse) {
    return std::isfinite(relmse) ? fmt::format("estimated relMSE {:.3g} (noise of about {:.2g} %)",
                                               relmse, 100.0 * std::sqrt(relmse))
                                 : "the error is not known: it takes more samples";
}

/// Three lines: what was made, how good it is, how long it took; the layers. The rest for who
/// asks.
void print_summary(const RenderResult& result, const RenderCommand& command,
                   const CommonOptions& common) {
    fmt::print("{}: {} x {} pixels, {} bands, {} samples a pixel{}\n", command.output.string(),
               result.image.width, result.image.height, result.plan.film.count, result.samples,
               command.png.empty() ? "" : fmt::format("; picture: {}", command.png.string()));
    const double pixels =
        static_cast<double>(result.image.width) * static_cast<double>(result.image.height);
    fmt::print("{}{}\n", error_text(result.relmse),
               command.outside > 0
                   ? fmt::format("; {:.3g} % of the pixels lie outside the display's gamut",
                                 100.0 * static_cast<double>(command.outside) / pixels)
                   : "");
    const double rendering = result.trace_seconds + result.shade_seconds;
    fmt::print("{:.2f} s: set-up {:.2f}, kernels {:.2f}, rays {:.2f}, shading {:.2f}; {:.2f} "
               "million paths/s\n",
               result.total_seconds, result.setup_seconds, result.build_seconds,
               result.trace_seconds, result.shade_seconds,
               rendering > 0.0 ? static_cast<double>(result.paths) / rendering * 1e-6 : 0.0);
    if (!result.light_layers.empty()) {
        std::vector<std::string> names;
        for (const LightLayer& layer : result.light_layers)
            names.push_back(layer.name());
        fmt::print("light groups: {}\n", fmt::join(names, ", "));
    }
    if (!common.verbose)
        return;
    for (const std::string& note : result.notes)
        fmt::print("{}\n", note);
    fmt::print("left out of the kernels: {}\n", fmt::join(result.left_out, "; "));
}

/// Returns true when the output file is already this render, with as many samples.
bool is_done(const RenderCommand& command, const Scene& scene, const Device& device) {
    std::error_code ignored;
    if (!command.render.resume ||
        std::filesystem::exists(checkpoint_beside(command.output), ignored) ||
        !std::filesystem::is_regular_file(command.output, ignored))
        return false;
    const SpectralImage image = read_spectral_exr(command.output);
    const auto& attributes = image.attributes;
    const auto identity = attributes.find(render_identity_attribute);
    const auto samples = attributes.find("reradiant:samples");
    return identity != attributes.end() && samples != attributes.end() &&
           identity->second == identity_digest(render_identity(scene, device, command.render)) &&
           samples->second == std::to_string(command.render.samples);
}

int report_interruption(const RenderResult& result, const RenderCommand& command) {
    fmt::print(stderr, "interrupted after {} samples a pixel; {}\n", result.samples,
               command.render.checkpoint.empty() ? "nothing was written"
                                                 : fmt::format("{} holds them, --resume goes on",
                                                               command.render.checkpoint.string()));
    return exit_interrupted;
}

/// Renders, alone or with a team, until a stop rule is met or somebody interrupts.
RenderResult render_image(const RenderCommand& command, const CommonOptions& common,
                          const Scene& scene, const Device& device, Team* team) {
    TevPreview preview(team == nullptr || team->leads() ? command.tev : "",
                       command.output.filename().string());
    RenderObserver show;
    if (preview.is_open())
        show = [&preview](const RenderProgress&, const std::function<SpectralImage()>& image) {
            if (preview.is_open())
                preview.update(image());
        };
    // from its first pass on a render ends with a pass and a checkpoint
    const RenderHooks hooks{.on_set_up = catch_interrupts, .time_counts_from = command.begun};
    RenderOptions options = command.render;
    options.hooks = &hooks;
    ProgressBar bar(common.quiet);
    bar.update("setting up tables and kernels");
    const auto progress = [&](const RenderProgress& state) {
        const double by_samples = static_cast<double>(state.samples) / command.render.samples;
        const std::chrono::duration<double> so_far =
            std::chrono::steady_clock::now() - command.begun;
        const double by_time = so_far.count() / command.render.time_seconds;
        bar.update(std::min(1.0, std::max(by_samples, by_time)),
                   std::isfinite(state.relmse)
                       ? fmt::format("{} spp, relMSE {:.2g}", state.samples, state.relmse)
                       : fmt::format("{} spp", state.samples));
        return !interrupt_requested();
    };
    return team != nullptr ? render_together(scene, device, options, *team, progress, show)
                           : render(scene, device, options, progress, show);
}

void write_results(RenderCommand& command, const RenderResult& result) {
    Picture picture;
    picture.exposure_ev = command.display.display.exposure_ev;
    if (command.display.auto_exposure)
        picture = develop(result.image, command.display);
    write_spectral_exr(command.output, result.image, picture.exposure_ev, result.light_layers);
    std::error_code ignored; // not before: what a full disk does not take can be written later
    if (!command.render.checkpoint.empty())
        std::filesystem::remove(command.render.checkpoint, ignored);
    if (command.png.empty())
        return;
    if (!command.display.auto_exposure)
        picture = develop(result.image, command.display);
    write_picture(command.png, picture);
    command.outside = picture.out_of_gamut;
}

int run_render(RenderCommand command, const CommandContext& context) {
    command.begun = std::chrono::steady_clock::now();
    CommonOptions common = context.common;
    const std::unique_ptr<Team> team = join_team(common);
    apply_texts(command, common);
    const std::vector<NamedOutput> outputs = {{"-o", command.output, {".exr"}},
                                              {"--png", command.png, {".png"}}};
    check_outputs(common, outputs, {command.scene});
    check_exposure(command.display.display.exposure_ev);
    if (command.shows_a_display())
        check_develop(command.display);
    const Scene scene = load_scene(command.scene);
    check_outputs(common, outputs, named_files());
    team ? catch_interrupts() : end_at_interrupts(); // teams end together
    prepare_opencl(common.threads);
    const Device device(common.device);
    command.render.checkpoint = checkpoint_beside(command.output);
    command.render.processes_on_machine = members_on_host(team);
    const bool done = is_done(command, scene, device);
    if (team ? team->from_leader(done) != 0 : done) {
        if (!common.quiet)
            fmt::print("{}: is this render already, with {} samples a pixel\n",
                       command.output.string(), command.render.samples);
        return 0;
    }
    if (!team || team->leads())
        if (const std::string warning = unchecked_device_warning(device.info()); !warning.empty())
            logging::warn("{}", warning);
    RenderResult result = render_image(command, common, scene, device, team.get());
    if (team && !team->leads())
        return 0;
    if (result.interrupted)
        return report_interruption(result, command);
    describe_image(result, scene, device, command.render, context.command_line);
    if (result.non_finite > 0)
        logging::warn("{} samples were not finite and were left out", result.non_finite);
    write_results(command, result);
    if (!common.json.empty()) {
        auto json = render_statistics(result, device, command.model);
        if (team)
            json["ranks"] = team->size();
        write_json(common.json, json);
    }
    if (!common.quiet)
        print_summary(result, command, common);
    return 0;
}

void add_stopping_options(Command app, RenderCommand& command) {
    app.option("--spp", command.render.samples, "samples a pixel (64 unless --time or --error)")
        .in_range(1u, 1u << 30)
        .when_given([&command] { command.samples_given = true; });
    app.option("--time", command.render.time_seconds,
               "stop after so many seconds, set-up included; one pass there is in any case")
        .positive();
    app.option("--error", command.render.relmse,
               "stop at this estimated relMSE: mean of (error / value)^2 over pixels and bands")
        .positive();
    app.option("--sample-range", command.sample_range,
               "only samples A to B - 1 of every pixel, as A:B");
    app.option("--checkpoint", command.render.checkpoint_seconds,
               "write OUT.exr.checkpoint every so many seconds")
        .positive()
        .show_default();
    app.flag("--resume", command.render.resume, "go on from OUT.exr.checkpoint where it exists");
    app.option("--memory-limit", command.render.memory_limit_bytes,
               "refuse a render that would take more bytes (default: 80 % of the machine's)");
}

void add_sampling_options(Command app, RenderCommand& command) {
    app.option("--model", command.model,
               "auto, adding, weidlich-wilkie or walk for every material");
    app.option("--wavelengths", command.wavelengths,
               "comb or comb:N: every path carries N wavelengths, spread over the film's bands "
               "(default: one a band); hero or hero:N: N of these (default 4), drawn at "
               "random, which is noisier");
    app.option("--comb-phase", command.phase,
               "where in its band a wavelength of the comb lies. random: anywhere; centre: at "
               "its centre")
        .one_of({"random", "centre"});
    app.option("--bands", command.bands, "film bands in nm, FROM:TO:STEP");
    app.option("--variance", command.variance, "bands: variance per band, too").one_of({"bands"});
    app.flag("--adaptive", command.render.adaptive,
             "more samples where the error is; --spp is then the mean over pixels");
    app.flag("--light-groups", command.render.light_groups,
             "keep what each [[light]] adds, or each `group` of them, as layers of the EXR; where "
             "something fluoresces, by its ultraviolet and its visible light");
    app.flag("--all-features", command.render.all_features,
             "compile everything, also what the scene does not need");
    app.flag("--double", command.render.in_double,
             "kernels in double precision, to see what single costs (sums over wavelengths and "
             "what is stored stay single)");
    app.option("--batch", command.render.batch_paths,
               "paths in flight; the image does not depend on it")
        .in_range(std::size_t{1}, std::size_t{1} << 24);
}

void add_picture_options(Command app, RenderCommand& command) {
    app.option("--png", command.png, "write the display image too");
    app.option("--tev", command.tev, "HOST:PORT of the viewer tev: shows every pass there");
    add_display_options(app, command.display_texts);
}

} // namespace

void add_render_command(Program& program, CommandContext& context) {
    auto command = std::make_shared<RenderCommand>();
    Command app = program.add_command("render", "path traces a scene to a spectral EXR");
    app.option("SCENE", command->scene, "scene file (TOML, or XML of Mitsuba 3)").required();
    app.option("-o,--output", command->output, "spectral EXR to write").required();
    add_stopping_options(app, *command);
    add_sampling_options(app, *command);
    add_picture_options(app, *command);
    app.footer("Example: reradiant render scene.toml -o out.exr --png out.png --spp 256");
    app.callback([command, &context] { context.exit_code = run_render(*command, context); });
}

} // namespace reradiant
