#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

namespace reradiant {

namespace {

using ConvergeCommand = ProgramTest;

constexpr const char* short_run =
    "converge scene.toml -o errors --methods auto,adding+comb:8 --time 0.05 --spp-reference 64";

} // namespace

TEST_F(ConvergeCommand, WritesCurvesPlotAndPage) {
    put("scene.toml", small_scene());
    const ProgramResult result = run(std::string(short_run) + " --json out.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const std::string csv = file_bytes(folder / "errors/curve.csv");
    EXPECT_TRUE(csv.starts_with("method,seconds,seconds_with_setup,spp,relmse,relmse_srgb,rmse,"
                                "ciede2000,bias,bias_stderr\nauto,"))
        << csv;
    EXPECT_NE(csv.find("\nadding+comb:8,"), std::string::npos);
    const auto json = nlohmann::json::parse(file_bytes(folder / "errors/curve.json"));
    EXPECT_EQ(json, nlohmann::json::parse(file_bytes(folder / "out.json")));
    ASSERT_EQ(json.at("methods").size(), 2u);
    double before = 0.0;
    for (const auto& row : json.at("methods")[0].at("rows")) {
        EXPECT_GT(row.at("seconds").get<double>(), before);
        EXPECT_GT(row.at("seconds_with_setup"), row.at("seconds"));
        before = row.at("seconds").get<double>();
    }
    EXPECT_GE(before, 0.05) << "the last row is the end of the method's time";
    EXPECT_NE(file_bytes(folder / "errors/error-over-time.svg").find("<svg"), std::string::npos);
    const std::string page = file_bytes(folder / "errors/index.html");
    EXPECT_NE(page.find("href=\"data:image/png;base64,"), std::string::npos);
    EXPECT_EQ(page.find("src="), std::string::npos) << "the page needs no other file";
}

TEST_F(ConvergeCommand, GoesOnWithTheMethodsThatAreMissing) {
    put("scene.toml", small_scene());
    ASSERT_EQ(run(short_run).exit_code, 0);
    const std::string first = file_bytes(folder / "errors/curve.csv");
    std::filesystem::remove(folder / "errors/methods/adding+comb-8.json");
    const ProgramResult again = run(short_run);
    ASSERT_EQ(again.exit_code, 0) << again.errors;
    const std::string second = file_bytes(folder / "errors/curve.csv");
    const auto auto_rows = [](const std::string& csv) {
        return csv.substr(0, csv.find("\nadding+comb:8,"));
    };
    EXPECT_EQ(auto_rows(first), auto_rows(second)) << "kept: to the last digit of its times";
    EXPECT_NE(first, second) << "measured again";
    EXPECT_NE(again.output.find("kept from an earlier run"), std::string::npos);
    // Another seed, another scene: nothing is kept.
    EXPECT_EQ(run(std::string(short_run) + " --seed 5").output.find("kept"), std::string::npos);
}

TEST_F(ConvergeCommand, InterruptedItKeepsWhatIsFinished) {
    put("scene.toml", small_scene());
    write_spectral_exr(folder / "flat.exr", flat_image(8, 6, grid_from_range(380, 780, 10), 1.0f));
    const std::string two = "converge scene.toml -o errors --methods auto,weidlich-wilkie --time 1 "
                            "--reference flat.exr";
    EXPECT_EQ(run_until("errors/methods/auto.json", two), 130);
    const std::string csv = file_bytes(folder / "errors/curve.csv");
    EXPECT_NE(csv.find("\nauto,"), std::string::npos);
    EXPECT_EQ(csv.find("\nweidlich-wilkie,"), std::string::npos);
    const ProgramResult again = run(two);
    EXPECT_EQ(again.exit_code, 0) << again.errors;
    EXPECT_TRUE(file_bytes(folder / "errors/curve.csv").starts_with(csv)) << "kept";
}

TEST_F(ConvergeCommand, ReferenceOfAnotherSizeOrGridIsRefusedAtItsFile) {
    put("scene.toml", small_scene());
    write_spectral_exr(folder / "wide.exr", flat_image(9, 6, grid_from_range(380, 780, 10), 1.0f));
    write_spectral_exr(folder / "coarse.exr",
                       flat_image(8, 6, grid_from_range(380, 780, 20), 1.0f));
    expect_failure(2, "converge scene.toml -o errors --reference wide.exr",
                   "wide.exr: the reference has 9 x 6 pixels");
    expect_failure(2, "converge scene.toml -o errors --reference coarse.exr",
                   "coarse.exr: the reference has the bands");
    expect_failure(2, "converge scene.toml -o errors --reference missing.exr", "missing.exr");
}

TEST_F(ConvergeCommand, WrongMethodsAndFoldersAreRefusedBeforeAnythingIsRendered) {
    put("scene.toml", small_scene());
    expect_failure(2, "converge scene.toml -o errors --methods magic", "--methods: 'magic'");
    expect_failure(2, "converge scene.toml -o errors --methods ''", "--methods");
    expect_failure(2, "converge scene.toml -o no/errors", "no/errors");
    expect_failure(2, "converge scene.toml -o scene.toml", "scene.toml: is a file");
    expect_failure(2, "converge missing.toml -o errors", "missing.toml");
}

} // namespace reradiant
