#include "tests/tools/program_runner.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>
#include <unistd.h>

namespace reradiant {

namespace {

/// Renders that are interrupted, resumed and put together from parts.
class ResumeAndMerge : public ProgramTest {
protected:
    void SetUp() override { put("scene.toml", small_scene()); }

    /// Starts a render that would not end, and ends it `milliseconds` after there is a checkpoint.
    int interrupt(int signal, int milliseconds, const std::string& more = "") const {
        const pid_t child = ::fork();
        if (child == 0) {
            const std::string command = "cd '" + (folder / "").string() +
                                        "' && exec '" RERADIANT_PROGRAM "' render scene.toml -o "
                                        "out.exr --spp 1000000 --checkpoint 0.05 --quiet " +
                                        more + " 2>errors.txt";
            ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
            ::_exit(127);
        }
        using namespace std::chrono_literals;
        for (int tries = 0; tries < 6000; ++tries) {
            if (std::filesystem::exists(folder / "out.exr.checkpoint"))
                break;
            std::this_thread::sleep_for(10ms);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        ::kill(child, signal);
        int status = 0;
        ::waitpid(child, &status, 0);
        return status;
    }

    std::vector<float> values(const std::string& name) const {
        return read_spectral_exr(folder / name).values;
    }
    double spp_of(const std::string& json, const char* key = "spp") const {
        return nlohmann::json::parse(file_bytes(folder / json)).at(key).get<double>();
    }
};

} // namespace

TEST_F(ResumeAndMerge, Case57ResumedRenderEqualsTheUninterruptedOne) {
    run("render scene.toml -o warm.exr --spp 1"); // the kernels are built
    const int status = interrupt(SIGINT, 100);
    ASSERT_TRUE(WIFEXITED(status));
    ASSERT_EQ(WEXITSTATUS(status), 130) << file_bytes(folder / "errors.txt");
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr")) << "a part is no result";
    ASSERT_TRUE(std::filesystem::exists(folder / "out.exr.checkpoint"));
    // The moment of the interruption decides how far there is to go.
    ASSERT_EQ(run("render scene.toml -o out.exr --resume --time 0.001 --json state.json").exit_code,
              0);
    const auto done = static_cast<int>(spp_of("state.json", "resumed_spp"));
    ASSERT_GT(done, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr.checkpoint"));
    ASSERT_EQ(run("render scene.toml -o whole.exr --spp " + std::to_string(done)).exit_code, 0);
    EXPECT_EQ(values("out.exr"), values("whole.exr"));
}

TEST_F(ResumeAndMerge, ResumeGoesOnFromTheCheckpoint) {
    run("render scene.toml -o warm.exr --spp 1");
    interrupt(SIGTERM, 150);
    const std::string kept = file_bytes(folder / "out.exr.checkpoint");
    const auto header = nlohmann::json::parse(kept.substr(
        kept.find('\n') + 1, kept.find('\n', kept.find('\n') + 1) - kept.find('\n') - 1));
    const int wanted = header.at("passes").back().at(0).get<int>() + 100;
    const std::string spp = " --spp " + std::to_string(wanted);
    ASSERT_EQ(run("render scene.toml -o out.exr --resume --json out.json" + spp).exit_code, 0);
    EXPECT_EQ(spp_of("out.json"), wanted);
    EXPECT_EQ(spp_of("out.json", "resumed_spp"), wanted - 100);
    ASSERT_EQ(run("render scene.toml -o whole.exr" + spp).exit_code, 0);
    EXPECT_EQ(values("out.exr"), values("whole.exr"));
}

TEST_F(ResumeAndMerge, Case56KilledRenderLeavesACheckpointThatLoads) {
    run("render scene.toml -o warm.exr --spp 1");
    for (const int milliseconds : {50, 330, 410, 490, 570, 650}) {
        interrupt(SIGKILL, milliseconds, "--resume");
        std::filesystem::copy_file(folder / "out.exr.checkpoint", folder / "copy.exr.checkpoint",
                                   std::filesystem::copy_options::overwrite_existing);
        const ProgramResult result =
            run("render scene.toml -o copy.exr --resume --time 0.001 --json copy.json");
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_GT(spp_of("copy.json", "resumed_spp"), 0);
    }
}

TEST_F(ResumeAndMerge, Case58AnotherSceneOrSettingIsRefusedByNameAndADoneRenderIsDone) {
    run("render scene.toml -o warm.exr --spp 1");
    interrupt(SIGINT, 50);
    ASSERT_TRUE(std::filesystem::exists(folder / "out.exr.checkpoint"));
    expect_failure(2, "render scene.toml -o out.exr --resume --seed 9", "the seed is 9, not 0");
    expect_failure(2, "render scene.toml -o out.exr --resume --bands 400:700:20", "the bands");
    put("scene.toml", replaced(small_scene(), "0.5", "0.6"));
    expect_failure(2, "render scene.toml -o out.exr --resume", "the scene is");
    put("scene.toml", replaced(small_scene(), "width = 8", "width = 9"));
    expect_failure(2, "render scene.toml -o out.exr --resume", "the scene is");

    put("scene.toml", small_scene());
    ASSERT_EQ(run("render scene.toml -o done.exr --spp 3").exit_code, 0);
    const auto written = std::filesystem::last_write_time(folder / "done.exr");
    const ProgramResult again = run("render scene.toml -o done.exr --spp 3 --resume");
    EXPECT_EQ(again.exit_code, 0) << again.errors;
    EXPECT_EQ(std::filesystem::last_write_time(folder / "done.exr"), written);
}

TEST_F(ResumeAndMerge, Case58EditedHeaderOfTheKernelsIsAnotherBuild) {
    interrupt(SIGINT, 0);
    ASSERT_TRUE(std::filesystem::exists(folder / "out.exr.checkpoint"));
    const std::filesystem::path source = RERADIANT_SOURCE_DIR;
    std::filesystem::create_directories(folder / "data");
    for (const char* part : {"spectra", "kernels"})
        std::filesystem::copy(source / part, folder / "data" / part,
                              std::filesystem::copy_options::recursive);
    std::ofstream(folder / "data/kernels/core/table.h", std::ios::app) << "// edited\n";
    expect_failure(2, "render scene.toml -o out.exr --spp 1000000 --resume", "build",
                   "RERADIANT_DATA=data");
}

TEST_F(ResumeAndMerge, DamagedCheckpointsAreRefused) {
    run("render scene.toml -o warm.exr --spp 1");
    interrupt(SIGINT, 50);
    const std::string good = file_bytes(folder / "out.exr.checkpoint");
    ASSERT_GT(good.size(), 1000u);
    const std::string resume = "render scene.toml -o out.exr --resume --spp 1";
    for (const std::size_t length :
         {std::size_t{0}, std::size_t{5}, std::size_t{200}, good.size() / 2, good.size() - 1}) {
        put("out.exr.checkpoint", good.substr(0, length));
        expect_failure(2, resume, "out.exr.checkpoint: is no whole checkpoint");
    }
    std::string flipped = good;
    flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 0x10);
    put("out.exr.checkpoint", flipped);
    expect_failure(2, resume, "its checksum is wrong");
    put("out.exr.checkpoint", good + "x");
    expect_failure(2, resume, "it is not as long as it must be");
}

TEST_F(ResumeAndMerge, MergedPartsAreTheWholeInAnyOrder) {
    const std::string render = "render scene.toml --seed 3 --variance bands ";
    for (const char* range : {"0:5", "5:6", "6:20"})
        ASSERT_EQ(run(render + "--sample-range " + range + " -o " + std::string(range, 1) + ".exr")
                      .exit_code,
                  0);
    ASSERT_EQ(run(render + "--spp 20 -o whole.exr").exit_code, 0);
    ASSERT_EQ(run("merge 6.exr 0.exr 5.exr -o a.exr --json a.json").exit_code, 0);
    ASSERT_EQ(run("merge 0.exr 5.exr 6.exr -o b.exr").exit_code, 0);
    ASSERT_EQ(run("merge 0.exr 5.exr -o 05.exr").exit_code, 0);
    ASSERT_EQ(run("merge 05.exr 6.exr -o c.exr").exit_code, 0);
    const SpectralImage whole = read_spectral_exr(folder / "whole.exr");
    const SpectralImage merged = read_spectral_exr(folder / "a.exr");
    EXPECT_EQ(merged.values, values("b.exr"));
    EXPECT_EQ(spp_of("a.json"), 20);
    ASSERT_EQ(merged.sample_count, whole.sample_count);
    const std::vector<float> twice = values("c.exr");
    for (std::size_t i = 0; i < whole.values.size(); ++i) {
        const float value = whole.values[i];
        ASSERT_NEAR(merged.values[i], value, 1e-6f * value);
        ASSERT_NEAR(twice[i], value, 1e-6f * value);
        // means are floats: their squares cancel to parts in 1e6 of the mean's square
        ASSERT_NEAR(merged.variance_bands[i], whole.variance_bands[i],
                    1e-4f * whole.variance_bands[i] + 1e-6f * value * value);
    }
}

TEST_F(ResumeAndMerge, RangeThatBeginsWithAnOddSampleKnowsItsError) {
    // Its odd half has the sample more; taken for the even one, the estimate was near 0.4.
    for (const char* range : {"0:3", "1:4"})
        ASSERT_EQ(run("render scene.toml -o part.exr --sample-range " + std::string(range) +
                      " --json " + std::string(range, 1) + ".json")
                      .exit_code,
                  0);
    EXPECT_LT(spp_of("1.json", "relmse"), 4.0 * spp_of("0.json", "relmse"));
}

TEST_F(ResumeAndMerge, OverlapsAndStrangersAreRefusedAndGapsNamed) {
    const std::string render = "render scene.toml -o ";
    ASSERT_EQ(run(render + "a.exr --sample-range 0:4").exit_code, 0);
    ASSERT_EQ(run(render + "b.exr --sample-range 3:6").exit_code, 0);
    ASSERT_EQ(run(render + "c.exr --sample-range 6:8").exit_code, 0);
    ASSERT_EQ(run(render + "d.exr --sample-range 4:6 --seed 2").exit_code, 0);
    expect_failure(2, "merge a.exr b.exr -o out.exr", "samples 3 to 3 are in a.exr too");
    expect_failure(2, "merge a.exr a.exr -o out.exr", "samples 0 to 3 are in a.exr too");
    expect_failure(2, "merge a.exr d.exr -o out.exr", "the seed is 2, not 0");
    const ProgramResult gap = run("merge c.exr a.exr -o out.exr --json out.json");
    EXPECT_EQ(gap.exit_code, 0);
    EXPECT_NE(gap.errors.find("samples 4 to 5 are missing"), std::string::npos) << gap.errors;
    EXPECT_NE(file_bytes(folder / "out.json").find("\"4:6\""), std::string::npos);
    put("e.exr", "no image");
    expect_failure(2, "merge a.exr e.exr -o more.exr", "e.exr");
}

} // namespace reradiant
