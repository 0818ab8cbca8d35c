#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace reradiant {

namespace {

using RenderCommand = ProgramTest;

} // namespace

TEST_F(RenderCommand, WritesImagePictureAndStatistics) {
    put("scene.toml", small_scene());
    const ProgramResult result =
        run("render scene.toml -o out.exr --png out.png --json out.json --spp 4 --seed 3 --quiet");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, "");
    const SpectralImage image = read_spectral_exr(folder / "out.exr");
    EXPECT_EQ(image.width, 8);
    EXPECT_EQ(image.height, 6);
    EXPECT_EQ(image.attributes.at("reradiant:seed"), "3");
    EXPECT_EQ(file_bytes(folder / "out.png").substr(1, 3), "PNG");
    const auto json = nlohmann::json::parse(file_bytes(folder / "out.json"));
    for (const char* key :
         {"spp", "seconds", "paths", "rays", "paths_per_second", "relmse", "non_finite", "device",
          "bands", "model", "wavelengths", "features", "left_out", "peak_memory_bytes"})
        EXPECT_TRUE(json.contains(key)) << key;
    EXPECT_EQ(folder.file_count(), 4u) << "scene, image, picture and statistics";
}

TEST_F(RenderCommand, EndsWithThreeLinesAndSaysTheRestWhenAsked) {
    put("scene.toml", small_scene());
    const std::string command =
        "render scene.toml -o out.exr --png out.png --spp 4 --json out.json";
    const ProgramResult brief = run(command), verbose = run(command + " --verbose");
    ASSERT_EQ(brief.exit_code, 0) << brief.errors;
    EXPECT_EQ(std::count(brief.output.begin(), brief.output.end(), '\n'), 3) << brief.output;
    for (const char* word :
         {"out.exr: 8 x 6 pixels", "4 samples a pixel", "estimated relMSE", " s: set-up "})
        EXPECT_NE(brief.output.find(word), std::string::npos) << brief.output;
    const auto json = nlohmann::json::parse(file_bytes(folder / "out.json"));
    ASSERT_FALSE(json.at("notes").empty());
    ASSERT_FALSE(json.at("left_out").empty());
    for (const char* key : {"notes", "left_out"})
        for (const auto& text : json.at(key)) {
            EXPECT_NE(verbose.output.find(text.get<std::string>()), std::string::npos) << text;
            EXPECT_EQ(brief.output.find(text.get<std::string>()), std::string::npos) << text;
        }
}

TEST_F(RenderCommand, SameSeedGivesTheSameImageWhateverTheThreads) {
    put("scene.toml", small_scene());
    ASSERT_EQ(run("render scene.toml -o a.exr --spp 4 --seed 3 --threads 1").exit_code, 0);
    ASSERT_EQ(run("render scene.toml -o b.exr --spp 4 --seed 3 --threads 2").exit_code, 0);
    ASSERT_EQ(run("render scene.toml -o c.exr --spp 4 --seed 4").exit_code, 0);
    const SpectralImage a = read_spectral_exr(folder / "a.exr");
    EXPECT_EQ(a.values, read_spectral_exr(folder / "b.exr").values);
    EXPECT_NE(a.values, read_spectral_exr(folder / "c.exr").values);
}

TEST_F(RenderCommand, WithoutAnOpenClDeviceItFailsWithARemedyAndNoFile) {
    put("scene.toml", small_scene());
    const std::string none = "OCL_ICD_VENDORS=/nonexistent";
    expect_failure(1, "render scene.toml -o out.exr --png out.png --json out.json", "OpenCL", none);
    expect_failure(1, "devices", "OpenCL", none);
}

TEST_F(RenderCommand, UnknownDeviceFailsWithTheListOfDevices) {
    put("scene.toml", small_scene());
    expect_failure(1, "render scene.toml -o out.exr --device no-such-device", "choose one of 0:");
}

TEST_F(RenderCommand, KernelThatFailsToBuildIsReportedAndLeavesNoImage) {
    put("scene.toml", small_scene());
    const std::filesystem::path source = RERADIANT_SOURCE_DIR;
    const TemporaryFolder data("data");
    std::filesystem::copy(source / "spectra", data / "spectra",
                          std::filesystem::copy_options::recursive);
    std::filesystem::copy(source / "kernels", data / "kernels",
                          std::filesystem::copy_options::recursive);
    std::ofstream(data / "kernels/shade.cl", std::ios::app) << "\nthis is no OpenCL C;\n";
    expect_failure(1, "render scene.toml -o out.exr --png out.png", "shade.cl",
                   "RERADIANT_DATA=" + (data / "").string() +
                       " RERADIANT_CACHE=" + (data / "cache").string());
}

TEST_F(RenderCommand, Case53FullDiskIsARunTimeFailure) {
    put("scene.toml", small_scene());
    expect_failure(1, "render scene.toml -o /dev/full --spp 1", "/dev/full");
    expect_failure(1, "render scene.toml -o /dev/null --png /dev/full --spp 1", "/dev/full");
}

TEST_F(RenderCommand, OutputFolderThatDoesNotExistIsRefusedBeforeRendering) {
    put("scene.toml", small_scene());
    expect_failure(2, "render scene.toml -o missing/out.exr --spp 1", "missing/out.exr");
}

} // namespace reradiant
