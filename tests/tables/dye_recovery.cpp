// Prints how well `fit --dye` recovers known dyes in a varnish from synthetic data, as a Markdown
// table: one line a case, the mean of several data sets, and what the inner-filter correction makes
// of the same data where it is told the dye's true absorption.
#include "host/fit/dye/dye_problem.h"
#include "host/fit/dye/result/inner_filter.h"
#include "reradiant/error.h"
#include "tests/tables/dye_recovery_cases.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

namespace reradiant {

namespace {

struct TableOptions {
    bool full = false;
    unsigned data_sets = 2, seed = 1;
};

/// Means over the data sets and dyes, but the longest seconds.
struct TableLine {
    DyeCase what;
    DyeError error;
    double yield_covered = 0.0, depth_covered = 0.0, most_seconds = 0.0;
    double inner_filter = std::numeric_limits<double>::quiet_NaN();
    int failures = 0;
};

/// The yield by the usual correction, relative to the true one.
double inner_filter_error(const std::vector<BispectralData>& data, const DyeCase& what) {
    const DyeFitSettings settings = dye_settings(what);
    const PreparedDyes prepared = prepare_dyes(data, settings, 1.0);
    const DyeProblem& problem = prepared.problem;
    const SlabDye& dye = settings.material.stack.layers[0].dyes[0];
    Eigen::VectorXd depth(problem.bands.count);
    for (int band = 0; band < problem.bands.count; ++band)
        depth(band) = what.depths.front() * dye.absorption(problem.bands.centre_nm(band));
    const auto filter =
        inner_filter(settings.material.stack, prepared.sets.front().views.front(), depth, problem);
    return corrected_dye(*filter, prepared.sets.front().blocks.front(), problem).quantum_yield /
               dye.quantum_yield -
           1.0;
}

void add_fit(const TableOptions& options, unsigned seed, TableLine& line) {
    const DyeCase& what = line.what;
    std::vector<BispectralData> data;
    for (std::size_t s = 0; s < what.depths.size(); ++s)
        data.push_back(
            synthesise(dye_recipe(what, what.depths[s]), seed + 1000u * static_cast<unsigned>(s))
                .data);
    const std::clock_t start = std::clock(); // counts all threads and no other process
    const DyeFitResult result = fit_dyes(data, dye_settings(what));
    line.most_seconds =
        std::max(line.most_seconds, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    line.failures += result.failure.empty() ? 0 : 1;
    const double share = 1.0 / (options.data_sets * static_cast<double>(what.dyes));
    for (int k = 0; k < what.dyes; ++k) {
        const DyeError error = dye_error(what, result, k);
        line.error.yield += share * std::fabs(error.yield);
        line.error.peak_depth += share * std::fabs(error.peak_depth);
        line.error.absorption_of_peak += share * error.absorption_of_peak;
        line.error.emission_of_peak += share * error.emission_of_peak;
        line.error.spectra_covered += share * error.spectra_covered;
        line.yield_covered += share * (error.yield_is_covered ? 1.0 : 0.0);
        line.depth_covered += share * (error.depth_is_covered ? 1.0 : 0.0);
    }
    const bool is_usual = what.dyes == 1 && what.reflectance == 0.0 && what.alpha == 0.0;
    if (is_usual && seed == options.seed)
        line.inner_filter = inner_filter_error(data, what);
}

std::vector<DyeCase> cases_of(const TableOptions& options) {
    std::vector<DyeCase> cases;
    const std::vector<double> depths = options.full ? std::vector<double>{0.05, 0.5, 1.0, 2.0, 5.0}
                                                    : std::vector<double>{0.5, 2.0};
    const std::vector<double> noises =
        options.full ? std::vector<double>{0.001, 0.01, 0.05} : std::vector<double>{0.01};
    for (const double reflectance : {0.9, 0.0})
        for (const double alpha : {0.0, 0.3})
            for (const double depth : depths)
                for (const double noise : noises)
                    cases.push_back({1, {depth}, noise, alpha, reflectance});
    for (const double noise : noises) {
        cases.push_back({1, {0.2, 2.0}, noise, 0.0, 0.9});
        cases.push_back({1, {0.2, 2.0}, noise, 0.0, 0.0});
        cases.push_back({2, {1.0}, noise, 0.0, 0.9});
        cases.push_back({2, {0.2, 2.0}, noise, 0.0, 0.9});
    }
    return cases;
}

void print_line(const TableLine& line) {
    std::string depths;
    for (const double depth : line.what.depths)
        depths += fmt::format("{}{}", depths.empty() ? "" : " and ", depth);
    fmt::print(
        "| {} | {} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} | "
        "{:.0f} | {} | {:.1f} | {} |\n",
        line.what.reflectance > 0.0 ? "white" : "black", line.what.alpha > 0.0 ? "rough" : "smooth",
        line.what.dyes, depths, 100.0 * line.what.noise_of_peak, 100.0 * line.error.yield,
        100.0 * line.error.peak_depth, 100.0 * line.error.absorption_of_peak,
        100.0 * line.error.emission_of_peak, 100.0 * line.error.spectra_covered,
        100.0 * line.yield_covered, 100.0 * line.depth_covered,
        std::isfinite(line.inner_filter) ? fmt::format("{:+.0f}", 100.0 * line.inner_filter) : "-",
        line.most_seconds, line.failures);
    std::fflush(stdout);
}

int run(const TableOptions& options) {
    fmt::print("{} data sets a case\n\n", options.data_sets);
    fmt::print(
        "| ground | face | dyes | depth | noise % | yield off by % | depth off by % | absorption "
        "RMSE % | emission RMSE % | spectra held % | yield held % | depth held % | inner filter "
        "off "
        "by % | most CPU s | failed |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "|\n");
    int failures = 0;
    for (const DyeCase& what : cases_of(options)) {
        TableLine line;
        line.what = what;
        for (unsigned k = 0; k < options.data_sets; ++k)
            add_fit(options, options.seed + k, line);
        print_line(line);
        failures += line.failures;
    }
    constexpr int exit_missed = 3;
    fmt::print("\n{} fits did not converge.\n", failures);
    return failures == 0 ? 0 : exit_missed;
}

} // namespace

} // namespace reradiant

int main(int argc, char** argv) {
    using namespace reradiant;
    TableOptions options;
    CLI::App program("Recovery of known dyes in a varnish by `fit --dye`, as a table. Exits with 3 "
                     "when a fit does not converge.");
    program.add_flag("--full", options.full, "depths of 0.05 to 5 and noise of 0.1 to 5 %");
    program.add_option("--data-sets", options.data_sets, "noise of so many seeds, averaged")
        ->check(CLI::PositiveNumber);
    program.add_option("--seed", options.seed, "of the noise of the first data set");
    CLI11_PARSE(program, argc, argv);
    try {
        return run(options);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return error.exit_code();
    }
}
