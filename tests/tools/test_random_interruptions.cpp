// A render that is interrupted again and again, at random moments, ends as if it never had been.
#include "tests/support/full_run.h"
#include "tests/tools/program_runner.h"

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <unistd.h>

namespace reradiant {

namespace {

/// A fluorescent sphere under a rough coat, lit by a lamp.
std::string coated_scene() {
    const std::string bare = small_scene();
    return bare.substr(0, bare.find("[material.substrate]")) +
           "[[material.layer]]\n"
           "ior = 1.5\n"
           "alpha = 0.2\n"
           "thickness = 0.5\n"
           "[material.substrate]\n"
           "type = \"lambert\"\n"
           "[material.substrate.reradiation]\n"
           "reflectance = 0.1\n"
           "[[material.substrate.reradiation.fluorophores]]\n"
           "excitation = { gaussian_nm = 440, sigma_nm = 50, scale = 0.9 }\n"
           "emission = { gaussian_nm = 600, sigma_nm = 22, scale = 1 }\n"
           "quantum_yield = 0.9\n";
}

class RandomInterruptions : public ProgramTest {
protected:
    void SetUp() override { put("scene.toml", coated_scene()); }

    /// Runs a render that would not end for so long, then sends it the signal.
    void interrupt(const std::string& options, int signal, int milliseconds) const {
        const pid_t child = ::fork();
        if (child == 0) {
            const std::string command = "cd '" + (folder / "").string() +
                                        "' && exec '" RERADIANT_PROGRAM "' render scene.toml -o "
                                        "out.exr --spp 1000000 --checkpoint 0.05 --resume --quiet" +
                                        options + " 2>>errors.txt";
            ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
            ::_exit(127);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        ::kill(child, signal);
        int status = 0;
        ::waitpid(child, &status, 0);
        const bool killed = WIFSIGNALED(status) && WTERMSIG(status) == signal;
        EXPECT_TRUE(killed || (WIFEXITED(status) && WEXITSTATUS(status) == 130))
            << file_bytes(folder / "errors.txt");
    }

    void expect_same_end(const std::string& options, int interruptions) const {
        run("render scene.toml -o warm.exr --spp 1" + options); // the kernels are built
        std::mt19937 random(20);
        // from the program's start to many checkpoints later
        std::uniform_int_distribution<int> milliseconds(0, 1200);
        for (int k = 0; k < interruptions; ++k)
            interrupt(options, random() % 2 == 0 ? SIGTERM : SIGKILL, milliseconds(random));
        const int done = samples_kept();
        RecordProperty("samples", done);
        const std::string end = " --spp " + std::to_string(done + 7) + options;
        ASSERT_EQ(run("render scene.toml -o out.exr --resume --json out.json" + end).exit_code, 0);
        ASSERT_EQ(run("render scene.toml -o whole.exr --json whole.json" + end).exit_code, 0);
        const SpectralImage resumed = read_spectral_exr(folder / "out.exr");
        const SpectralImage whole = read_spectral_exr(folder / "whole.exr");
        EXPECT_EQ(resumed.values, whole.values);
        EXPECT_EQ(resumed.variance_y, whole.variance_y);
        EXPECT_EQ(resumed.sample_count, whole.sample_count);
        const auto json = [&](const char* name) {
            return nlohmann::json::parse(file_bytes(folder / name));
        };
        EXPECT_EQ(json("out.json").at("relmse"), json("whole.json").at("relmse"));
        EXPECT_EQ(json("out.json").at("paths"), json("whole.json").at("paths"));
        EXPECT_EQ(json("out.json").at("rays"), json("whole.json").at("rays"));
    }

    /// Returns the samples a pixel that the checkpoint holds; 0 when every interruption came before
    /// the first one.
    int samples_kept() const {
        const std::string kept = file_bytes(folder / "out.exr.checkpoint");
        if (kept.empty())
            return 0;
        const std::size_t first = kept.find('\n') + 1;
        const auto header =
            nlohmann::json::parse(kept.substr(first, kept.find('\n', first) - first));
        return header.at("passes").back().at(0).get<int>();
    }
};

} // namespace

TEST_F(RandomInterruptions, Case57ResumedRenderEqualsTheUninterruptedOne) {
    expect_same_end("", test::is_full_run() ? 50 : 3);
}

TEST_F(RandomInterruptions, Case57WithHeroWavelengthsToo) {
    if (!test::is_full_run())
        GTEST_SKIP() << "only in full runs";
    expect_same_end(" --wavelengths hero", 50);
}

TEST_F(RandomInterruptions, Case57WithWalksToo) {
    if (!test::is_full_run())
        GTEST_SKIP() << "only in full runs";
    expect_same_end(" --model walk", 50);
}

} // namespace reradiant
