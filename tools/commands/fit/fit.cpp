#include "reradiant/fit.h"
#include "host/base/logging.h"
#include "host/fit/result/fit_memory.h"
#include "host/fit/result/fit_report.h"
#include "host/fit/result/fit_summary.h"
#include "host/fit/solver/solve_journal.h"
#include "host/report/json_file.h"
#include "host/report/progress.h"
#include "host/scene/model/named_files.h"
#include "host/scene/toml/stack_file.h"
#include "reradiant/error.h"
#include "reradiant/scene_file.h"
#include "reradiant/spectral_files.h"
#include "tools/commands/fit/fit_dyes.h"
#include "tools/program/command.h"
#include "tools/program/interrupt.h"
#include "tools/program/kept_work.h"
#include "tools/program/outputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

namespace reradiant {

namespace {

/// The results are written, but they are not all that the data say.
constexpr int exit_not_within_noise = 3;

struct FitOptions {
    std::vector<std::filesystem::path> all_data;
    std::filesystem::path data, output, stack, report, model_file, covariance;
    std::string model = "factors", loss = "none", mask = "auto";
    std::optional<int> rank;
    std::optional<double> smooth_nm, spill_nm;
    std::optional<std::size_t> bytes;
    std::vector<std::string> unknown;
    DyeOptions dye;
    bool anti_stokes = false;
    double seconds = 60.0;
    std::uint64_t memory_limit_bytes = 0;
    int iterations = SolverSettings{}.most_iterations;
    double checkpoint_seconds = 60.0;
    bool resume = false;
};

FitSettings settings_of(const FitOptions& options, const CommonOptions& common) {
    FitSettings settings;
    settings.model = fit_model_from_name(options.model);
    settings.loss = robust_loss_from_name(options.loss);
    settings.rank = options.rank;
    settings.smooth_nm = options.smooth_nm;
    settings.most_bytes = options.bytes;
    settings.spill_nm = options.spill_nm;
    settings.mask = mask_rules_from_text(options.mask);
    settings.anti_stokes = options.anti_stokes;
    settings.covariance = !options.covariance.empty();
    settings.unknown = unknown_layers_from_names(options.unknown);
    settings.seed = common.seed;
    settings.solver.most_seconds = options.seconds;
    settings.solver.most_iterations = options.iterations;
    settings.threads = common.threads;
    if (!options.stack.empty() && options.dye.layer.empty())
        settings.stack = load_stack(options.stack);
    return settings;
}

void print_summary(const FitOptions& options, const FitResult& result) {
    fmt::print(
        "{}: model {}, {} term{}, {} bytes, relative RMSE {:.4f}, {} iterations in {:.2f} s\n",
        options.output.string(), fit_model_name(result.model), result.rank,
        result.rank == 1 ? "" : "s", result.bytes, result.relative_rmse, result.trace.iterations,
        result.seconds);
    bool has_yields = false;
    for (std::size_t k = 0; k < result.quantum_yield.size(); ++k) {
        const QuantumYield& yield = result.quantum_yield[k];
        if (!std::isfinite(yield.value))
            continue;
        fmt::print("quantum yield {}: {:.3f} ({:.3f} to {:.3f}) of all photons that the sample "
                   "absorbs\n",
                   k + 1, yield.value, yield.low, yield.high);
        has_yields = true;
    }
    if (has_yields)
        fmt::print("of the photons that a dye itself absorbs, its yield is as high or higher\n");
    fmt::print("the data determine {} of the model's {} numbers\n", result.covariance_rank,
               result.parameters);
    if (result.stack)
        for (std::size_t k = 0; k < result.stack->names.size(); ++k)
            fmt::print("{}: {:.6g} +- {:.2g}\n", result.stack->names[k],
                       result.stack->value(static_cast<Eigen::Index>(k)),
                       result.stack->sigma(static_cast<Eigen::Index>(k)));
    for (const std::string& note : result.notes)
        fmt::print("{}\n", note);
}

void warn(const FitResult& result) {
    for (const std::string& warning : result.warnings)
        logging::warn("{}", warning);
    if (result.stack)
        for (const std::string& ambiguity : result.stack->ambiguities)
            logging::warn("{}", ambiguity);
}

/// Says in the last line that residuals are not noise, and returns the exit code. It is no failure
/// where the user chose how much the model may hold.
int judge(const FitOptions& options, const CommonOptions& common, const FitResult& result) {
    if (result.shortfall.empty())
        return 0;
    const bool was_chosen = options.rank || options.bytes;
    if (!common.quiet || !was_chosen)
        fmt::print(common.quiet ? stderr : stdout, "{}: {}\n", options.data.string(),
                   result.shortfall);
    return was_chosen ? 0 : exit_not_within_noise;
}

/// Returns all that the steps of a fit depend on, by name.
SampleIdentity fit_identity(const FitOptions& options, const FitSettings& settings,
                            const BispectralData& data) {
    const auto number = [](const auto& value) {
        return value ? fmt::format("{}", *value) : std::string("by itself");
    };
    return {{"data", file_digest(options.data)},
            {"stack", settings.stack ? stack_digest(*settings.stack, data.emission) : "none"},
            {"stack's file", settings.stack ? file_digest(options.stack) : "none"},
            {"unknown", fmt::format("{}", fmt::join(options.unknown, ","))},
            {"model", options.model},
            {"loss", options.loss},
            {"rank", number(options.rank)},
            {"smoothing", number(options.smooth_nm)},
            {"spill", number(options.spill_nm)},
            {"mask", options.mask},
            {"bytes", number(options.bytes)},
            {"anti-stokes", options.anti_stokes ? "on" : "off"},
            {"seed", std::to_string(settings.seed)},
            {"most seconds", fmt::format("{}", options.seconds)},
            {"most iterations", std::to_string(options.iterations)}};
}

/// Fits with a checkpoint. Returns nothing when it was interrupted, which it says. What fails
/// writes the JSON that was asked for: what it was and how far the fit got.
std::optional<FitResult> fit_and_keep(const FitOptions& options, FitSettings settings,
                                      const BispectralData& data, const CommonOptions& common) {
    KeptWork kept(options.output, fit_identity(options, settings, data),
                  options.checkpoint_seconds);
    SolveJournal journal;
    if (options.resume)
        kept.resume([&](const nlohmann::json& state) { journal = SolveJournal(state); });
    ProgressBar bar(common.quiet);
    std::size_t steps = 0;
    journal.set_after_step([&] {
        kept.keep_when_due([&] { return journal.json(); });
        bar.update(fmt::format("{} steps of minimisations", ++steps));
    });
    settings.solver.journal = &journal;
    settings.solver.stop = interrupt_flag();
    catch_interrupts();
    try {
        FitResult result = fit_reradiation(data, settings);
        kept.remove();
        return result;
    } catch (const Interrupted&) {
        fmt::print(stderr, "{}\n", kept.interruption_text());
        return std::nullopt;
    } catch (const Error& error) {
        if (error.kind() == Error::Kind::Runtime)
            write_json(common.json,
                       fit_failure_summary(settings.model, error.what(), journal.progress()));
        throw;
    }
}

/// Refuses what only belongs to the one or the other kind of fit.
void check_kind(const FitOptions& options) {
    if (const std::string option = options.dye.given_without_layer(); !option.empty())
        throw_input_error({}, option + " is for dyes in a layer", "add --dye LAYER");
    if (options.dye.layer.empty()) {
        if (options.all_data.size() > 1)
            throw_input_error({options.all_data[1].string()},
                              "several data sets are fitted together for dyes in a layer alone",
                              "fit them one by one, or add --dye LAYER");
        return;
    }
    const bool has_other = !options.covariance.empty() || options.bytes || options.resume ||
                           options.model != "factors" || options.loss != "none";
    if (has_other)
        throw_input_error({},
                          "--covariance, --bytes, --resume, --model and --loss are not for fits of "
                          "dyes in a layer",
                          "leave them out, or leave --dye out");
}

int run_fit(FitOptions options, const CommonOptions& common) {
    check_kind(options);
    options.data = options.all_data.front();
    const std::vector<NamedOutput> outputs = {
        {"-o", options.output, {".csv", ".exr", ".bfc"}, true},
        {"--report", options.report, {".html"}},
        {"--model-file", options.model_file, {".toml"}},
        {"--covariance", options.covariance, {".csv"}}};
    std::vector<std::filesystem::path> inputs = options.all_data;
    inputs.insert(inputs.end(), {options.stack, options.dye.lamp});
    check_outputs(common, outputs, inputs);
    const FitSettings settings = settings_of(options, common);
    if (!options.dye.layer.empty())
        return run_dye_fit(
            options.dye,
            {options.all_data, options.stack, options.output, options.report, options.model_file},
            settings, common);
    check_outputs(common, outputs, named_files());
    const BispectralData data = read_bispectral_data(options.data);
    check_fit_memory(data, settings, options.memory_limit_bytes);
    const std::optional<FitResult> fitted = fit_and_keep(options, settings, data, common);
    if (!fitted)
        return exit_interrupted;
    const FitResult& result = *fitted;
    warn(result);
    if (!result.failure.empty()) {
        write_json(common.json, fit_summary(result));
        throw_runtime_error(options.data.string() + ": " + result.failure,
                            "try another --model or --rank, or --loss huber for outliers");
    }
    write_reradiation(options.output, result.matrix);
    if (!options.model_file.empty()) {
        const std::filesystem::path beside =
            std::filesystem::relative(std::filesystem::absolute(options.output),
                                      std::filesystem::absolute(options.model_file).parent_path());
        const double difference = write_model_file(options.model_file, result, beside);
        if (difference > 0.01)
            logging::warn(
                "{}: tables integrated over the bands differ from the fitted matrix by up "
                "to {:.1f} % of its peak",
                options.model_file.string(), 100.0 * difference);
    }
    if (result.covariance)
        write_covariance_csv(options.covariance, *result.covariance);
    if (!options.report.empty())
        write_fit_report(options.report, data, result);
    write_json(common.json, fit_summary(result));
    if (!common.quiet)
        print_summary(options, result);
    return judge(options, common, result);
}

} // namespace

void add_fit_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<FitOptions>();
    Command command = program.add_command(
        "fit", "Fits a re-radiation matrix to bispectral data, bare or through a layer");
    command
        .option("DATA", options->all_data,
                "re-radiation CSV, CSV of `measure`, .BFC or .exr; several with --dye")
        .required();
    command.option("-o,--output", options->output, "re-radiation matrix to write").required();
    command.option("--model", options->model, "factors, gaussians or matrix").show_default();
    command.option(
        "--rank", options->rank,
        "terms (dyes, roughly): 1 to 4 factors or 1 to 24 gaussians; default: as many as "
        "the data show");
    const CommandOption smooth =
        command.option("--smooth-nm", options->smooth_nm,
                       "spacing of the spline functions of factors, 0: one number a band");
    command
        .option("--bytes", options->bytes,
                "most bytes that the fitted factors may take: values at the bands that matter "
                "most, straight lines between")
        .excludes(smooth);
    command
        .option("--spill-nm", options->spill_nm,
                "entries this near to the diagonal are not fitted; default: one band")
        .non_negative();
    command
        .option("--mask", options->mask,
                "entries that count as not measured: auto (scatter of the monochromators that "
                "stands out), none, or a list such as first:20,second:15,third:10,half:10 "
                "(+- nm about emission = 1, 2, 3, 1/2 x excitation; never the diagonal) and "
                "box:300-350x500-560 (excitation x emission)")
        .show_default();
    command.option("--memory-limit", options->memory_limit_bytes,
                   "refuse a fit that would take more bytes (default: 80 % of the machine's)");
    command
        .option("--loss", options->loss,
                "how outliers count: none (as all others), huber or cauchy (less)")
        .show_default();
    command.option("--stack", options->stack, "MATERIAL.toml whose layers lay above the sample");
    command
        .option("--unknown", options->unknown,
                "numbers of the stack that are fitted, too: thickness,absorption,ior")
        .delimiter(',');
    add_dye_options(command, options->dye);
    command.flag("--anti-stokes", options->anti_stokes,
                 "emission below the excitation is possible");
    command.option("--report", options->report, "HTML report to write");
    command.option("--model-file", options->model_file,
                   "compact model as TOML, usable as RERADIATION");
    command.option("--covariance", options->covariance,
                   "CSV of what is uncertain about the matrix, for `colour --covariance`");
    command.option("--most-seconds", options->seconds, "time limit of one minimisation")
        .positive()
        .show_default();
    command
        .option("--most-iterations", options->iterations,
                "limit of Ceres' steps in one minimisation")
        .positive()
        .show_default();
    command
        .option("--checkpoint", options->checkpoint_seconds,
                "write MATRIX.csv.checkpoint every so many seconds")
        .positive()
        .show_default();
    command.flag("--resume", options->resume, "go on from MATRIX.csv.checkpoint where it exists");
    command.footer(
        "Exits with 3, everything written, when the data hold more than the model found "
        "in them. A fit that fails (exit code 1) writes --json alone: its `failure` and how far "
        "it got.\nExample: reradiant fit orange.BFC -o orange.csv --report orange.html");
    command.callback(
        [options, &context] { context.exit_code = run_fit(*options, context.common); });
}

} // namespace reradiant
