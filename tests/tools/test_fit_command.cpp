#include "tests/tools/program_runner.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace reradiant;

namespace {

using FitCommand = ProgramTest;

/// A measured matrix of one fluorophore on 30 bands, in the form of spectra/README.md.
std::string measured_csv() {
    std::string text = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                       "# kind: measured\nnm";
    for (int i = 0; i < 30; ++i)
        text += fmt::format(",{}", 400 + 10 * i);
    text += '\n';
    for (int o = 0; o < 30; ++o) {
        text += fmt::format("{}", 400 + 10 * o);
        for (int i = 0; i < 30; ++i) {
            const double e = (o - 18) / 3.0, x = (i - 8) / 4.0;
            // A fixed ripple stands for noise.
            const double noise = 2e-4 * std::sin(12.9898 * o + 78.233 * i);
            text += fmt::format(",{}", (o == i  ? 0.2
                                        : o > i ? 0.05 * std::exp(-0.5 * (e * e + x * x))
                                                : 0.0) +
                                           noise);
        }
        text += '\n';
    }
    return text;
}

/// Returns a measured matrix of one fluorophore on 40 emission and 10 excitation bands, with light
/// at twice the excitation that is as bright as the fluorescence.
std::string csv_with_scatter() {
    std::string text = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                       "# kind: measured\nnm";
    for (int i = 0; i < 10; ++i)
        text += fmt::format(",{}", 300 + 10 * i);
    text += '\n';
    for (int o = 0; o < 40; ++o) {
        text += fmt::format("{}", 400 + 10 * o);
        for (int i = 0; i < 10; ++i) {
            const double e = (o - 6) / 3.0, x = (i - 4) / 4.0;
            const double line = 400 + 10 * o == 2 * (300 + 10 * i) ? 0.05 : 0.0;
            text += fmt::format(",{}", 0.05 * std::exp(-0.5 * (e * e + x * x)) + line +
                                           2e-4 * std::sin(12.9898 * o + 78.233 * i));
        }
        text += '\n';
    }
    return text;
}

} // namespace

TEST_F(FitCommand, ItsCovarianceGivesColoursWithIntervals) {
    put("data.csv", measured_csv());
    const ProgramResult fitted =
        run("fit data.csv -o out.csv --rank 1 --covariance cov.csv --report report.html");
    ASSERT_EQ(fitted.exit_code, 0) << fitted.errors;
    const std::string report = file_bytes(folder / "report.html");
    EXPECT_NE(report.find("Under D65, for the observer of 1931: data and fit."), std::string::npos);
    EXPECT_NE(report.find("Neither re-radiates visible light under ultraviolet light."),
              std::string::npos)
        << "the data begin at 400 nm";
    const ProgramResult seen =
        run("colour out.csv --covariance cov.csv --illuminant D65,A --json colour.json");
    ASSERT_EQ(seen.exit_code, 0) << seen.errors;
    EXPECT_NE(seen.output.find("95 % of Lab:"), std::string::npos) << seen.output;
    const auto colour = nlohmann::json::parse(file_bytes(folder / "colour.json"));
    for (const char* lamp : {"D65", "A"}) {
        const auto& told = colour[lamp];
        EXPECT_EQ(told["intervals"]["level"], 0.95);
        EXPECT_EQ(told["intervals"]["draws"], 1000);
        for (const char* way : {"linearised", "drawn"})
            for (std::size_t c = 0; c < 3; ++c) {
                const auto& lab = told["intervals"][way]["Lab"];
                EXPECT_LT(lab["low"][c], told["Lab"][c]) << lamp << way;
                EXPECT_GT(lab["high"][c], told["Lab"][c]) << lamp << way;
                EXPECT_GT(told["intervals"][way]["uv_excluded"]["XYZ"]["standard_error"][c], 0.0);
            }
    }
    EXPECT_EQ(run("colour out.csv --standard-errors out.csv").exit_code, 0);
}

TEST_F(FitCommand, CovariancesOfSomethingElseAreRefused) {
    put("data.csv", measured_csv());
    ASSERT_EQ(run("fit data.csv -o out.csv --rank 1 --covariance cov.csv").exit_code, 0);
    expect_failure(2, "colour data.csv --covariance cov.csv", "belongs to another matrix");
    expect_failure(2, "colour out.csv --covariance out.csv", "out.csv:1:1");
    expect_failure(2, "colour out.csv data.csv --covariance cov.csv", "one sample");
    expect_failure(2, "colour --preset red-lacquer --covariance cov.csv", "not a material");
    expect_failure(2, "colour out.csv --covariance cov.csv --standard-errors out.csv",
                   "--standard-errors");
    expect_failure(2, "colour out.csv --standard-errors data.csv", "standard error at emission");
    expect_failure(2, "colour out.csv --covariance none.csv", "none.csv");
    expect_failure(2, "fit data.csv -o new.csv --model matrix --covariance new-cov.csv",
                   "choose factors or gaussians");
    expect_failure(2, "fit data.csv -o new.csv --covariance data.csv", "data.csv");
    const std::string whole = file_bytes(folder / "cov.csv");
    put("half.csv", whole.substr(0, whole.rfind('\n', whole.size() / 2) + 1));
    expect_failure(2, "colour out.csv --covariance half.csv", "half.csv:");
    expect_failure(2, "validate half.csv", "half.csv:");
    expect_failure(2, "colour cov.csv", "which --covariance takes");
    EXPECT_NE(run("validate cov.csv").output.find("covariance of a re-radiation matrix"),
              std::string::npos);
}

TEST_F(FitCommand, MasksScatterAndSaysSo) {
    put("data.csv", csv_with_scatter());
    const std::string line = "second-order scatter at emission = 2 x excitation +- 5 nm";
    const ProgramResult result =
        run("fit data.csv -o out.csv --rank 1 --report report.html --json fit.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find(line), std::string::npos) << result.output;
    const auto json = nlohmann::json::parse(file_bytes(folder / "fit.json"));
    EXPECT_EQ(json["mask"]["rules"], "auto,second:5");
    EXPECT_EQ(json["mask"]["entries"], 10);
    EXPECT_LT(json["relative_rmse"].get<double>(), 0.02);
    const std::string report = file_bytes(folder / "report.html");
    EXPECT_NE(report.find("--mask auto,second:5"), std::string::npos);
    EXPECT_NE(report.find("equal at all wavelengths from 300 to 400 nm"), std::string::npos);
    EXPECT_NE(report.find(line), std::string::npos);
    const ProgramResult kept = run("fit data.csv -o out.csv --rank 1 --mask none --json fit.json");
    EXPECT_EQ(kept.output.find("scatter"), std::string::npos);
    EXPECT_GT(nlohmann::json::parse(file_bytes(folder / "fit.json"))["relative_rmse"], 0.1);
    expect_failure(2, "fit data.csv -o new.csv --mask secnd:5", "secnd:5");
    expect_failure(2, "fit data.csv -o new.csv --mask box:0-900x0-900", "data.csv");
    for (const char* const use : {"validate data.csv", "info data.csv", "colour data.csv"}) {
        const ProgramResult used = run(use);
        EXPECT_EQ(used.exit_code, 0) << use << used.errors;
        EXPECT_NE((used.output + used.errors).find(line), std::string::npos) << use;
    }
}

TEST_F(FitCommand, WritesMatrixModelReportAndJson) {
    put("data.csv", measured_csv());
    const ProgramResult result = run("fit data.csv -o out.csv --rank 1 --model-file model.toml "
                                     "--report report.html --json fit.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const auto json = nlohmann::json::parse(file_bytes(folder / "fit.json"));
    EXPECT_EQ(json["model"], "factors");
    EXPECT_EQ(json["rank"], 1);
    EXPECT_EQ(json["bytes"], 4 * 60);
    EXPECT_EQ(json["converged"], true);
    EXPECT_TRUE(json["failure"].is_null());
    EXPECT_LE(json["kkt"].get<double>(), 1e-8);
    EXPECT_EQ(json["anti_stokes_energy"], 0.0);
    EXPECT_LT(json["relative_rmse"].get<double>(), 0.02);
    EXPECT_GT(json["iterations"].get<int>(), 0);
    EXPECT_GT(json["seconds"].get<double>(), 0.0);
    ASSERT_EQ(json["quantum_yield"].size(), 1u);
    EXPECT_LE(json["quantum_yield"][0]["low"], json["quantum_yield"][0]["value"]);
    EXPECT_NE(file_bytes(folder / "out.csv").find("# kind: model"), std::string::npos);
    EXPECT_EQ(run("validate out.csv").exit_code, 0);
    EXPECT_EQ(run("validate model.toml").exit_code, 0);
}

TEST_F(FitCommand, WhatTheTermsDoNotFollowIsTheLastLineAndExit3) {
    // A line that moves with the excitation has as many terms as there are excitations.
    std::string text = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                       "# kind: measured\nnm";
    for (int i = 0; i < 30; ++i)
        text += fmt::format(",{}", 400 + 10 * i);
    for (int o = 0; o < 30; ++o) {
        text += fmt::format("\n{}", 400 + 10 * o);
        for (int i = 0; i < 30; ++i)
            text +=
                fmt::format(",{}", (o > i ? 0.05 * std::exp(-0.5 * std::pow(o - i - 6, 2)) : 0.0) +
                                       2e-4 * std::sin(12.9898 * o + 78.233 * i));
    }
    put("data.csv", text + '\n');
    const ProgramResult result = run("fit data.csv -o out.csv --json fit.json");
    EXPECT_EQ(result.exit_code, 3) << result.errors;
    const std::size_t end = result.output.find_last_not_of('\n');
    const std::size_t last = result.output.rfind('\n', end) + 1;
    EXPECT_EQ(result.output.find("data.csv: the residuals are", last), last) << result.output;
    const auto json = nlohmann::json::parse(file_bytes(folder / "fit.json"));
    EXPECT_EQ(json["within_noise"], false);
    EXPECT_EQ(run("validate out.csv").exit_code, 0);
    // As many terms as were asked for are no failure.
    EXPECT_EQ(run("fit data.csv -o out.csv --rank 2").exit_code, 0);
}

TEST_F(FitCommand, FewEntriesWithoutNoiseAreFluorescence) {
    put("few.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                   "nm,300,310,320,330\n300,0.2,0,0,0\n310,0.1,0.3,0,0\n320,0.1,0.1,0.3,0\n"
                   "330,0.05,0.1,0.2,0.4\n");
    const ProgramResult fitted = run("fit few.csv -o out.csv");
    EXPECT_EQ(fitted.exit_code, 0) << fitted.errors;
    EXPECT_NE(fitted.output.find("1 term,"), std::string::npos) << fitted.output;
}

TEST_F(FitCommand, BadInputIsRefusedAndNothingIsWritten) {
    put("data.csv", measured_csv());
    put("headless.csv", "# reradiation\nnm,400\n400,0.1\n");
    put("bare.toml", "[material]\n");
    expect_failure(2, "fit none.csv -o out.csv", "none.csv");
    expect_failure(2, "fit headless.csv -o out.csv", "headless.csv:");
    expect_failure(2, "fit data.csv -o out.csv --rank 9", "--rank 9");
    expect_failure(2, "fit data.csv -o out.csv --model splines", "--model splines");
    expect_failure(2, "fit data.csv -o out.csv --loss l1", "--loss l1");
    expect_failure(2, "fit data.csv -o nowhere/out.csv", "nowhere");
    expect_failure(2, "fit data.csv -o out.csv --stack bare.toml", "bare.toml:1");
    expect_failure(2, "fit data.csv -o out.csv --unknown thickness", "--stack");
}

TEST_F(FitCommand, WithoutConvergenceTheJsonAloneIsWritten) {
    put("data.csv", measured_csv());
    const std::string command = "fit data.csv -o out.csv --model-file m.toml --most-iterations 1";
    expect_failure(1, command, "did not converge");
    EXPECT_EQ(run(command + " --json j.json").exit_code, 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.csv"));
    EXPECT_FALSE(std::filesystem::exists(folder / "m.toml"));
    const auto json = nlohmann::json::parse(file_bytes(folder / "j.json"));
    EXPECT_EQ(json["failure"]["stage"], "minimisation");
    EXPECT_NE(json["failure"]["message"].get<std::string>().find("did not converge"),
              std::string::npos);
    EXPECT_EQ(json["converged"], false);
    EXPECT_GE(json["iterations"].get<int>(), 1);
    EXPECT_GT(json["kkt"].get<double>(), 0.0);
}
