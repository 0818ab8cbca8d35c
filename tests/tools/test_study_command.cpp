#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace reradiant {

namespace {

class StudyCommand : public ProgramTest {
protected:
    void SetUp() override {
        put("scene.toml", small_scene());
        put("study.toml", "[study]\nscene = \"scene.toml\"\n[render]\nspp = 2\n[measure]\n"
                          "[[sweep]]\nkey = \"material.grey.substrate.reflectance\"\n"
                          "values = [0.2, 0.8]\n");
    }
    nlohmann::json results() const {
        return nlohmann::json::parse(file_bytes(folder / "out.json"));
    }
};

} // namespace

TEST_F(StudyCommand, RendersMeasuresAndShowsEveryCell) {
    const ProgramResult result = run("study study.toml -o results --json out.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    for (const char* file :
         {"table.csv", "contact-sheet.png", "index.html", "cells/0000/image.exr",
          "cells/0001/image.png", "cells/0001/matrix.csv", "cells/0001/matrix.svg",
          "cells/0001/polar-45.svg", "cells/0001/cell.json"})
        EXPECT_TRUE(std::filesystem::exists(folder / "results" / file)) << file;
    EXPECT_EQ(results().at("failed"), 0);
    const SpectralImage dark = read_spectral_exr(folder / "results/cells/0000/image.exr");
    const SpectralImage light = read_spectral_exr(folder / "results/cells/0001/image.exr");
    EXPECT_NEAR(dark.at(4, 3, 10), 0.2, 0.01) << "a furnace shows the reflectance that was swept";
    EXPECT_NEAR(light.at(4, 3, 10), 0.8, 0.04);
    const std::string table = file_bytes(folder / "results/table.csv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5) << table;
}

TEST_F(StudyCommand, OneExposureOfTheSheetShowsTheBodies) {
    // Beneath radiance 0.5 bodies of 0.2 and 0.8 are well seen, beneath 50 they are lost.
    put("scene.toml", replaced(small_scene(), "radiance = 1.0", "radiance = 0.5"));
    ASSERT_EQ(run("study study.toml -o as-it-is --json out.json").exit_code, 0);
    EXPECT_EQ(results().at("exposure_ev"), 0.0);
    put("scene.toml", replaced(small_scene(), "radiance = 1.0", "radiance = 50.0"));
    ASSERT_EQ(run("study study.toml -o bright --json out.json").exit_code, 0);
    // Equal energy has 1.205 in red: log2(0.6 / (0.8 x 50 x 1.205)) = -6.33, kept to one digit.
    EXPECT_NEAR(results().at("exposure_ev").get<double>(), -6.3, 1e-9);
    const std::string page = file_bytes(folder / "bright/index.html");
    EXPECT_NE(page.find("same exposure, -6"), std::string::npos);
    put("study.toml",
        replaced(file_bytes(folder / "study.toml"), "spp = 2", "spp = 2\nexposure_ev = -3"));
    const std::string chosen = file_bytes(folder / "bright/cells/0000/image.png");
    ASSERT_EQ(run("study study.toml -o bright --json out.json").exit_code, 0);
    EXPECT_EQ(results().at("exposure_ev"), -3.0);
    EXPECT_EQ(results().at("results")[0].at("kept"), true) << "light is the same";
    EXPECT_NE(file_bytes(folder / "bright/cells/0000/image.png"), chosen);
}

TEST_F(StudyCommand, DoneCellsAreKeptAndChangedOnesAreDoneAgain) {
    ASSERT_EQ(run("study study.toml -o results").exit_code, 0);
    std::filesystem::remove(folder / "results/cells/0001/cell.json");
    const std::string page = file_bytes(folder / "results/index.html");
    ASSERT_EQ(run("study study.toml -o results --json out.json").exit_code, 0);
    EXPECT_EQ(results().at("results")[0].at("kept"), true);
    EXPECT_EQ(results().at("results")[1].at("kept"), false);
    EXPECT_EQ(file_bytes(folder / "results/index.html"), page) << "as if never interrupted";
    put("scene.toml", replaced(small_scene(), "radius = 1\n", "radius = 0.9\n"));
    ASSERT_EQ(run("study study.toml -o results --json out.json").exit_code, 0);
    EXPECT_EQ(results().at("results")[0].at("kept"), false);
}

TEST_F(StudyCommand, CellThatFailsIsReportedAndTheRestGoesOn) {
    put("study.toml", replaced(file_bytes(folder / "study.toml"), "[0.2, 0.8]", "[0.2, 1.5, 0.8]"));
    const ProgramResult result = run("study study.toml -o results --json out.json");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("cell 1 (material.grey.substrate.reflectance = 1.5) failed"),
              std::string::npos)
        << result.errors;
    EXPECT_EQ(results().at("failed"), 1);
    EXPECT_TRUE(std::filesystem::exists(folder / "results/cells/0002/image.exr"));
    EXPECT_NE(file_bytes(folder / "results/index.html").find("\"error\""), std::string::npos);
}

TEST_F(StudyCommand, BadStudiesAreRefusedAtTheirPlace) {
    const std::string study = file_bytes(folder / "study.toml");
    const auto refuse = [&](const std::string& from, const std::string& to,
                            const std::string& place) {
        put("bad.toml", replaced(study, from, to));
        expect_failure(2, "study bad.toml -o results", place);
    };
    refuse("[0.2, 0.8]", "[]", "bad.toml:8:1: the sweep is empty");
    refuse("[0.2, 0.8]", "[2, 3]", "bad.toml:8:11: no value of the sweep");
    refuse("grey", "gray", "bad.toml:7:1: the scene has no \"gray\"");
    refuse("scene.toml", "none.toml", "bad.toml:2:1: cannot open");
    refuse("spp = 2", "spp = 0", "bad.toml:4:1: spp is 0");
    expect_failure(2, "study study.toml -o study.toml", "study.toml: is a file");
    expect_failure(2, "study missing.toml -o results", "missing.toml");
}

TEST_F(StudyCommand, InterruptedItGoesOnWhereItStopped) {
    // The second cell would take minutes.
    const std::string study = "[study]\nscene = \"scene.toml\"\n[render]\nspp = 20000\n"
                              "[[sweep]]\nkey = \"film.width\"\nvalues = ";
    put("study.toml", study + "[1, 4096]\n");
    EXPECT_EQ(run_until("results/cells/0000/cell.json", "study study.toml -o results"), 130);
    EXPECT_FALSE(std::filesystem::exists(folder / "results/index.html"));
    put("study.toml", study + "[1]\n");
    ASSERT_EQ(run("study study.toml -o results --json out.json").exit_code, 0);
    EXPECT_EQ(results().at("results")[0].at("kept"), true);
}

} // namespace reradiant
