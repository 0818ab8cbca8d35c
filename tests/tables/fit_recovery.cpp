// Prints how well `fit` recovers known matrices from synthetic data, as a Markdown table: one line
// a case (grid, stack, number of fluorophores, noise). The README says how to run it.
#include "host/error.h"
#include "host/fit/fit.h"
#include "tests/tables/recovery_cases.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

namespace reradiant {

namespace {

struct TableOptions {
    std::vector<std::string> stacks{"bare", "smooth", "rough", "absorbing"};
    std::vector<double> steps_nm{10.0, 5.0}, noise_percent{0.1, 1.0, 5.0};
    std::vector<int> fluorophores{1, 2, 3, 4};
    std::string model = "factors";
    bool known_rank = false;
    unsigned seed = 1;
};

struct TableLine {
    RecoveryCase what;
    int rank = 0;
    RecoveryError error;
    double seconds = 0.0;
    std::string failure;
};

TableLine recover(const RecoveryCase& what, const TableOptions& options) {
    const SynthRecipe recipe = recovery_recipe(what);
    const SynthResult data = synthesise(recipe, options.seed);
    FitSettings settings;
    settings.model = fit_model_from_name(options.model);
    if (options.known_rank)
        settings.rank = what.fluorophores;
    if (!recipe.stack.layers.empty())
        settings.stack = recipe.stack;
    const auto start = std::chrono::steady_clock::now();
    const FitResult fit = fit_reradiation(data.data, settings);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return {what, fit.rank,
            recovery_error(synth_truth(recipe), fit.matrix, fit.sigma, settings.stack.has_value()),
            seconds.count(), fit.failure};
}

void print_line(const TableLine& line) {
    const RecoveryCase& what = line.what;
    fmt::print(
        "| {} | {} | {} | {} | {} | {:.3f} | {:.2f} | {:.2f} | {:.1f} | {:+.2f} | {:.1f} | {} |\n",
        recovery_stack_name(what.stack), what.step_nm, what.fluorophores, line.rank,
        100.0 * what.noise_of_peak, 100.0 * line.error.rmse_of_peak,
        line.error.rmse_of_peak / what.noise_of_peak,
        line.error.guessed_rmse_of_peak / what.noise_of_peak, 100.0 * line.error.coverage,
        100.0 * line.error.quantum_yield, line.seconds, line.failure.empty() ? "" : line.failure);
    std::fflush(stdout);
}

std::vector<RecoveryCase> cases_of(const TableOptions& options) {
    std::vector<RecoveryCase> cases;
    for (const RecoveryStack stack : recovery_stacks) {
        if (std::find(options.stacks.begin(), options.stacks.end(), recovery_stack_name(stack)) ==
            options.stacks.end())
            continue;
        for (const double step : options.steps_nm)
            for (const int count : options.fluorophores)
                for (const double percent : options.noise_percent)
                    cases.push_back({stack, step, count, 0.01 * percent});
    }
    return cases;
}

/// Cases that a bar of the project is missed in: noise not averaged down, or bands that lie.
int print_summary(const std::vector<TableLine>& lines) {
    int failed = 0, above_noise = 0, bad_bands = 0;
    for (const TableLine& line : lines) {
        failed += line.failure.empty() ? 0 : 1;
        above_noise += line.error.rmse_of_peak < line.what.noise_of_peak ? 0 : 1;
        bad_bands += line.error.coverage >= 0.90 && line.error.coverage <= 0.99 ? 0 : 1;
    }
    fmt::print("\n{} cases: {} did not converge, {} have an error above the noise, in {} the 95 % "
               "bands hold less than 90 or more than 99 % of the truth.\n",
               lines.size(), failed, above_noise, bad_bands);
    return failed + above_noise + bad_bands;
}

int run(const TableOptions& options) {
    fmt::print(
        "| stack | step nm | K | K found | noise % of peak | RMSE % of peak | RMSE / noise | "
        "the same, guessed | coverage % | quantum yield error % | s | failure |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    std::fflush(stdout);
    std::vector<TableLine> lines;
    for (const RecoveryCase& what : cases_of(options)) {
        lines.push_back(recover(what, options));
        print_line(lines.back());
    }
    constexpr int exit_missed = 3;
    return print_summary(lines) == 0 ? 0 : exit_missed;
}

} // namespace

} // namespace reradiant

int main(int argc, char** argv) {
    using namespace reradiant;
    TableOptions options;
    CLI::App program("Recovery of known re-radiation matrices by `fit`, as a table. Exits with 3 "
                     "when a case fails, exceeds its noise or has wrong error bands.");
    program.add_option("--stacks", options.stacks, "bare, smooth, rough, absorbing")
        ->delimiter(',')
        ->check(CLI::IsMember({"bare", "smooth", "rough", "absorbing"}));
    program.add_option("--steps", options.steps_nm, "steps of the grids in nm")
        ->delimiter(',')
        ->check(CLI::IsMember({5.0, 10.0}));
    program.add_option("--fluorophores", options.fluorophores, "how many dyes")
        ->delimiter(',')
        ->check(CLI::Range(1, 4));
    program.add_option("--noise", options.noise_percent, "read noise in % of the peak")
        ->delimiter(',')
        ->check(CLI::PositiveNumber);
    program.add_option("--model", options.model, "factors, gaussians or matrix");
    program.add_flag("--known-rank", options.known_rank, "give the number of dyes to the fit");
    program.add_option("--seed", options.seed, "of the noise");
    CLI11_PARSE(program, argc, argv);
    try {
        return run(options);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return error.exit_code();
    }
}
