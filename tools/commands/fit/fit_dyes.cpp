#include "tools/commands/fit/fit_dyes.h"

#include "host/base/logging.h"
#include "host/fit/dye/dye_fit.h"
#include "host/fit/dye/result/dye_report.h"
#include "host/fit/dye/result/dye_summary.h"
#include "host/report/json_file.h"
#include "reradiant/error.h"
#include "reradiant/scene_file.h"
#include "reradiant/spectral_files.h"

#include <fmt/core.h>

#include <charconv>
#include <cstdio>

namespace reradiant {

namespace {

constexpr int exit_not_within_noise = 3;

/// "1" is the layer at the air.
std::size_t layer_index(const std::string& text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || number < 1)
        throw_input_error({}, fmt::format("--dye {} is no layer", text),
                          "give its number, 1 at the air");
    return static_cast<std::size_t>(number - 1);
}

DyeFitSettings settings_of(const DyeOptions& options, const DyeFitFiles& files,
                           const FitSettings& fit) {
    if (files.stack.empty())
        throw_input_error({}, "--dye names a layer of a stack, and none is given",
                          "add --stack MATERIAL.toml");
    if (fit.anti_stokes)
        throw_input_error({}, "--anti-stokes does not go with --dye",
                          "leave it out: dyes send out longer waves than they absorb");
    if (fit.unknown.any())
        throw_input_error({}, "--unknown does not go with --dye",
                          "give the stack's numbers; the dye's depth is fitted anyway");
    DyeFitSettings settings;
    settings.material = load_material(files.stack);
    settings.material.position.file = files.stack.string();
    settings.layer = layer_index(options.layer);
    settings.dyes = fit.rank;
    settings.thickness = options.thickness;
    settings.concentration = options.concentration;
    settings.is_arbitrary_unit = options.unit == "arbitrary";
    if (!options.lamp.empty())
        settings.lamp = read_spectrum(options.lamp);
    settings.ceiling = options.ceiling;
    settings.fits_substrate = options.substrate == "fitted";
    settings.mask = fit.mask;
    settings.spill_nm = fit.spill_nm;
    settings.smooth_nm = fit.smooth_nm;
    settings.solver.most_iterations =
        std::min(settings.solver.most_iterations, fit.solver.most_iterations);
    settings.solver.most_seconds = fit.solver.most_seconds;
    return settings;
}

void write_results(const DyeFitFiles& files, const DyeFitSettings& settings,
                   const DyeFitResult& result) {
    write_reradiation(files.output, result.matrix);
    if (!files.model_file.empty())
        write_dye_material(files.model_file, result, files.stack, settings.layer);
    if (!files.report.empty())
        write_dye_report(files.report, result);
}

} // namespace

std::string DyeOptions::given_without_layer() const {
    if (!layer.empty())
        return {};
    return !thickness.empty()          ? "--thickness"
           : !concentration.empty()    ? "--concentration"
           : unit != "radiance-factor" ? "--unit"
           : substrate != "known"      ? "--substrate"
           : !lamp.empty()             ? "--lamp"
           : ceiling                   ? "--ceiling"
                                       : "";
}

void add_dye_options(Command& command, DyeOptions& options) {
    const std::string group = "Dyes in a layer";
    command
        .option("--dye", options.layer,
                "number of the stack's layer whose dyes are looked for, 1 at the air")
        .group(group);
    command.option("--thickness", options.thickness, "of that layer, one for each DATA: a,b,...")
        .delimiter(',')
        .one_at_a_time()
        .group(group);
    command
        .option("--concentration", options.concentration,
                "of its dyes, relative, one for each DATA: a,b,...")
        .delimiter(',')
        .one_at_a_time()
        .group(group);
    command
        .option("--unit", options.unit,
                "of the data: radiance-factor, or arbitrary (counts of an unknown scale)")
        .one_of({"radiance-factor", "arbitrary"})
        .show_default()
        .group(group);
    command
        .option("--lamp", options.lamp,
                "spectrum of the excitation that data of an arbitrary unit still hold")
        .group(group);
    command.option("--ceiling", options.ceiling, "values from here up are saturated").group(group);
    command
        .option("--substrate", options.substrate,
                "known (as the stack's file has it) or fitted: its reflectance")
        .one_of({"known", "fitted"})
        .show_default()
        .group(group);
}

int run_dye_fit(const DyeOptions& options, const DyeFitFiles& files, const FitSettings& fit,
                const CommonOptions& common) {
    const DyeFitSettings settings = settings_of(options, files, fit);
    std::vector<BispectralData> data;
    for (const std::filesystem::path& file : files.data)
        data.push_back(read_dye_data(file, settings.is_arbitrary_unit));
    const DyeFitResult result = fit_dyes(data, settings);
    for (const std::string& warning : result.warnings)
        logging::warn("{}", warning);
    write_json(common.json, dye_fit_summary(result));
    if (!result.failure.empty())
        throw_runtime_error(files.data.front().string() + ": " + result.failure,
                            "try --rank 1, --smooth-nm or a --mask of what is no fluorescence");
    write_results(files, settings, result);
    if (!common.quiet) {
        fmt::print("{}: {} dye{}, relative RMSE {:.4f}, {} iterations in {:.2f} s\n",
                   files.output.string(), result.dyes.size(), result.dyes.size() == 1 ? "" : "s",
                   result.relative_rmse, result.trace.iterations, result.seconds);
        for (const std::string& sentence : dye_sentences(result))
            fmt::print("{}\n", sentence);
        for (const std::string& note : result.notes)
            fmt::print("{}\n", note);
    }
    if (result.shortfall.empty())
        return 0;
    fmt::print(common.quiet ? stderr : stdout, "{}: {}\n", files.data.front().string(),
               result.shortfall);
    return fit.rank ? 0 : exit_not_within_noise;
}

} // namespace reradiant
