#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

namespace reradiant {

namespace {

using Json = nlohmann::json;

class CompareAndInfo : public ProgramTest {
protected:
    void write(const std::string& name, float value) const {
        SpectralImage image = flat_image(4, 3, grid_from_range(400, 700, 50), value);
        image.attributes["seed"] = "7";
        write_spectral_exr(folder / name, image);
    }
};

} // namespace

TEST_F(CompareAndInfo, CompareWritesTheKeysThatScriptsRead) {
    write("a.exr", 1.1f);
    write("b.exr", 1.0f);
    const ProgramResult result = run("compare a.exr b.exr --json result.json");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const Json json = Json::parse(file_bytes(folder / "result.json"));
    // 1e-6: the images are in single precision.
    EXPECT_NEAR(json.at("relmse").get<double>(), 0.01 / 1.01, 1e-6);
    EXPECT_NEAR(json.at("rmse").get<double>(), 0.1, 1e-6);
    EXPECT_NEAR(json.at("bias").get<double>(), 0.1, 1e-6);
    for (const char* key : {"relmse_srgb", "bias_stderr", "ciede2000"})
        EXPECT_TRUE(json.at(key).is_number()) << key;
    EXPECT_NE(result.output.find("relmse"), std::string::npos);
    EXPECT_EQ(run("compare a.exr b.exr --quiet").output, result.output)
        << "what one asked for is no noise";
}

TEST_F(CompareAndInfo, CompareExitsWithThreeOverTheLimit) {
    write("a.exr", 1.1f);
    write("b.exr", 1.0f);
    EXPECT_EQ(run("compare a.exr b.exr --max-relmse 0.0100").exit_code, 0);
    const ProgramResult result = run("compare a.exr b.exr --max-relmse 0.0098 --json r.json");
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.errors.find("a.exr"), std::string::npos) << result.errors;
    EXPECT_TRUE(Json::parse(file_bytes(folder / "r.json")).contains("relmse"));
}

TEST_F(CompareAndInfo, CompareRefusesImagesThatDoNotFit) {
    write("a.exr", 1.0f);
    write_spectral_exr(folder / "wide.exr", flat_image(5, 3, grid_from_range(400, 700, 50), 1.0f));
    const std::string whole = file_bytes(folder / "a.exr");
    put("cut.exr", whole.substr(0, whole.size() * 6 / 10));
    expect_failure(2, "compare a.exr wide.exr --json r.json", "a.exr");
    expect_failure(2, "compare a.exr missing.exr --json r.json", "missing.exr");
    expect_failure(2, "compare cut.exr a.exr --json r.json", "cut.exr");
}

TEST_F(CompareAndInfo, Case53ResultThatCannotBeWrittenIsARunTimeFailure) {
    write("a.exr", 1.0f);
    expect_failure(1, "compare a.exr a.exr --json /dev/full", "/dev/full");
    // The command line is wrong where a folder is not there, which is seen before anything is read.
    expect_failure(2, "compare a.exr a.exr --json missing/r.json", "missing/r.json");
}

TEST_F(CompareAndInfo, InfoSaysWhatEachKindOfFileHolds) {
    write("a.exr", 1.0f);
    put("scene.toml", small_scene());
    put("matrix.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                      "nm,400,500\n400,0.3,0\n500,0.2,0.5\n");
    put("spectrum.csv", "nm,value\n400,0.25\n500,0.75\n");
    put("material.toml", "[material]\nname = \"grey\"\n[material.substrate]\n"
                         "type = \"lambert\"\nreflectance = 0.5\n");
    const auto info = [&](const std::string& file) {
        const ProgramResult result = run("info " + file + " --json info.json");
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_NE(result.output.find("kind:"), std::string::npos) << result.output;
        EXPECT_EQ(run("info " + file + " --quiet").output, result.output);
        return Json::parse(file_bytes(folder / "info.json"));
    };
    const Json image = info("a.exr");
    EXPECT_EQ(image.at("kind"), "spectral image");
    EXPECT_EQ(image.at("bands").at("count"), 7);
    EXPECT_EQ(image.at("attributes").at("reradiant:seed"), "7");
    EXPECT_EQ(info("scene.toml").at("kind"), "scene");
    EXPECT_EQ(info("material.toml").at("kind"), "material");
    EXPECT_EQ(info("spectrum.csv").at("highest"), 0.75);
    const Json matrix = info("matrix.csv");
    EXPECT_EQ(matrix.at("kind"), "re-radiation matrix");
    EXPECT_NEAR(matrix.at("largest_radiant_column_sum").get<double>(), 0.5, 1e-12);
    EXPECT_EQ(matrix.at("fluorescent"), true);
}

TEST_F(CompareAndInfo, QuietSilencesReportsOfWhatWasWrittenAndNotResults) {
    put("scene.toml", small_scene());
    for (const auto& [command, word] : {std::pair{"validate scene.toml", "valid\n"},
                                        {"devices", "0: "},
                                        {"check --only film --samples 1000", "passed"},
                                        {"classify --class a", "start from: "}}) {
        const ProgramResult quiet = run(std::string(command) + " --quiet");
        EXPECT_EQ(quiet.exit_code, 0) << command << "\n" << quiet.errors;
        EXPECT_NE(quiet.output.find(word), std::string::npos) << command << "\n" << quiet.output;
        EXPECT_EQ(quiet.errors, "") << command;
    }
    put("flat.toml", "[material]\n[material.substrate]\ntype = \"lambert\"\n");
    for (const char* command : {"measure flat.toml -o m.csv", "render scene.toml -o o.exr --spp 1",
                                "classify --class a -o start.toml"}) {
        const ProgramResult quiet = run(std::string(command) + " --quiet");
        EXPECT_EQ(quiet.exit_code, 0) << quiet.errors;
        EXPECT_EQ(quiet.output.find("written"), std::string::npos) << quiet.output;
        EXPECT_EQ(quiet.output.find("o.exr"), std::string::npos) << quiet.output;
        EXPECT_EQ(quiet.output.find("m.csv"), std::string::npos) << quiet.output;
    }
}

TEST_F(CompareAndInfo, InfoRefusesWhatItCannotRead) {
    put("a.docx", "x");
    put("a.exr", "x");
    expect_failure(2, "info missing.exr --json r.json", "missing.exr");
    expect_failure(2, "info a.docx --json r.json", "a.docx");
    expect_failure(2, "info a.exr --json r.json", "a.exr");
    expect_failure(2, "info . --json r.json", ".: ");
}

} // namespace reradiant
