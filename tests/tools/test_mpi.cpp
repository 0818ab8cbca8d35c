// The program under mpirun, on this machine alone. Skipped, loudly, where it was built without MPI
// or where there is no mpirun.
#include "reradiant/spectral_image.h"
#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace reradiant {

namespace {

class Mpi : public ProgramTest {
protected:
    void SetUp() override {
        if (run("--version").output.find("no MPI") != std::string::npos)
            GTEST_SKIP() << "NOT TESTED: this build has no MPI";
        if (std::system("command -v mpirun >/dev/null") != 0)
            GTEST_SKIP() << "NOT TESTED: there is no mpirun";
        // In a container without /sys, for one, mpirun finds no cores.
        if (const ProgramResult idle = launch(1, "true"); idle.exit_code != 0)
            GTEST_SKIP() << "NOT TESTED: mpirun cannot start `true` here: "
                         << idle.errors.substr(0, idle.errors.find('\n'));
        put("scene.toml", small_scene());
    }

    /// One core a member, on a machine that may have fewer; a root's container may run it, too.
    ProgramResult launch(int ranks, const std::string& command) const {
        return shell("mpirun --allow-run-as-root --oversubscribe --bind-to none -n " +
                     std::to_string(ranks) + " " + command);
    }
    ProgramResult run_ranks(int ranks, const std::string& arguments) const {
        return launch(ranks, "'" RERADIANT_PROGRAM "' " + arguments);
    }
    ProgramResult shell(const std::string& command) const {
        const std::string inside =
            "cd '" + (folder / "").string() + "' && { " + command + "; } >mpi.out 2>mpi.err";
        const int status = std::system(inside.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_bytes(folder / "mpi.out"),
                file_bytes(folder / "mpi.err")};
    }

    nlohmann::json json(const std::string& name) const {
        return nlohmann::json::parse(file_bytes(folder / name));
    }
    void expect_equal(const std::string& image, const std::string& reference) const {
        const SpectralImage a = read_spectral_exr(folder / image);
        const SpectralImage b = read_spectral_exr(folder / reference);
        ASSERT_EQ(a.sample_count, b.sample_count);
        for (std::size_t i = 0; i < a.values.size(); ++i)
            ASSERT_NEAR(a.values[i], b.values[i], 1e-6f * std::abs(b.values[i])) << i;
        // The roundings are those of float sums of squares, scaled by halves whose sums are floats;
        // where all samples are the same the variance is a rounding.
        const float rounding = 1e-6f * *std::ranges::max_element(b.variance_y);
        for (std::size_t i = 0; i < a.variance_y.size(); ++i)
            ASSERT_NEAR(a.variance_y[i], b.variance_y[i],
                        1e-3f * std::abs(b.variance_y[i]) + rounding)
                << i;
    }
};

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

} // namespace

TEST_F(Mpi, AnyNumberOfRanksGivesThePictureOfOne) {
    ASSERT_EQ(run("render scene.toml -o one.exr --spp 301 --json one.json").exit_code, 0);
    for (const int ranks : {1, 2, 4}) {
        const ProgramResult result =
            run_ranks(ranks, "render scene.toml -o many.exr --spp 301 --json many.json");
        ASSERT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_EQ(count_of(result.output, "samples a pixel"), 1u) << "one rank speaks";
        expect_equal("many.exr", "one.exr");
        const auto many = json("many.json"), one = json("one.json");
        EXPECT_EQ(many.value("ranks", 1), ranks);
        EXPECT_EQ(many.at("paths"), one.at("paths"));
        EXPECT_EQ(many.at("rays"), one.at("rays"));
        const double error = one.at("relmse").get<double>();
        EXPECT_NEAR(many.at("relmse").get<double>(), error, 1e-4 * error) << "of the same halves";
    }
}

TEST_F(Mpi, RanksBringTheLightGroupsTogether) {
    ASSERT_EQ(run("render scene.toml -o one.exr --spp 64 --light-groups").exit_code, 0);
    ASSERT_EQ(run_ranks(2, "render scene.toml -o many.exr --spp 64 --light-groups").exit_code, 0);
    expect_equal("many.exr", "one.exr");
    std::vector<LightLayer> one;
    read_light_layers(folder / "one.exr", [&](LightLayer&& layer) { one.push_back(layer); });
    std::size_t k = 0;
    read_light_layers(folder / "many.exr", [&](LightLayer&& layer) {
        for (std::size_t i = 0; i < layer.values.size(); ++i)
            ASSERT_NEAR(layer.values[i], one.at(k).values[i], 1e-5f);
        ++k;
    });
    EXPECT_EQ(k, one.size());
}

TEST_F(Mpi, RulesThatStopARenderStopAllRanks) {
    ProgramResult result = run_ranks(2, "render scene.toml -o a.exr --error 1e-3 --json a.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_LE(json("a.json").at("relmse").get<double>(), 1e-3);
    const auto start = std::chrono::steady_clock::now();
    result = run_ranks(2, "render scene.toml -o b.exr --time 1 --json b.json");
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - start;
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_GE(whole.count(), 1.0) << "set-up is in it";
    EXPECT_LT(json("b.json").at("passes").back().at("seconds").get<double>(), 5.0);
    // The samples that were rendered are known exactly, so that one process can render them again.
    const auto samples = json("b.json").at("spp").get<int>();
    ASSERT_EQ(run("render scene.toml -o c.exr --spp " + std::to_string(samples)).exit_code, 0);
    expect_equal("b.exr", "c.exr");
}

TEST_F(Mpi, WhatIsWrongIsSaidOnceAndEndsAllRanks) {
    ProgramResult result = run_ranks(3, "render missing.toml -o out.exr");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(count_of(result.errors, "no such file"), 1u) << result.errors;
    result = run_ranks(3, "render scene.toml -o out.exr --spp 0");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(count_of(result.errors, "--spp"), 1u) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
    // Rank 1 alone has another scene. (A shell tells the ranks apart: where mpirun is given two
    // commands, that of Open MPI 5.0.7 crashes.)
    put("scene1.toml", replaced(small_scene(), "0.5", "0.6"));
    put("scene0.toml", small_scene());
    result = launch(2, "sh -c 'exec \"" RERADIANT_PROGRAM
                       "\" render scene$OMPI_COMM_WORLD_RANK.toml -o out.exr --spp 4'");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find("rank 1 has another scene"), std::string::npos) << result.errors;
}

TEST_F(Mpi, JobThatDiesGoesOnFromItsCheckpointWithAnyNumberOfRanks) {
    // mpirun dies without a word, and its ranks with it.
    const ProgramResult killed =
        shell("mpirun --allow-run-as-root --oversubscribe --bind-to none -n 2 '" RERADIANT_PROGRAM
              "' render scene.toml -o out.exr --spp 100000000 --checkpoint 0.2 & job=$!; tries=0; "
              "until test -e out.exr.checkpoint || test $tries = 600; do sleep 0.1; "
              "tries=$((tries + 1)); done; sleep 0.5; "
              "kill -KILL $job; wait $job; sleep 0.5");
    ASSERT_TRUE(std::filesystem::exists(folder / "out.exr.checkpoint")) << killed.errors;
    std::filesystem::copy_file(folder / "out.exr.checkpoint", folder / "alone.exr.checkpoint");
    const ProgramResult result =
        run_ranks(3, "render scene.toml -o out.exr --resume --time 0.001 --json state.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const auto kept = json("state.json").at("resumed_spp").get<int>();
    EXPECT_GT(kept, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr.checkpoint"));
    const std::string more = std::to_string(kept + 5);
    // One process goes on where many stopped, and many where one did.
    ASSERT_EQ(run("render scene.toml -o alone.exr --resume --spp " + more).exit_code, 0);
    ASSERT_EQ(run("render scene.toml -o whole.exr --spp " + more).exit_code, 0);
    expect_equal("alone.exr", "whole.exr");
}

TEST_F(Mpi, RankThatIsAskedToEndEndsAllWithACheckpoint) {
    // One rank is asked to end, as a batch system does to one machine; mpirun's own SIGTERM leaves
    // ranks a second.
    const ProgramResult result =
        shell("mpirun --allow-run-as-root --oversubscribe --bind-to none -n 2 '" RERADIANT_PROGRAM
              "' render scene.toml -o out.exr --spp 100000000 --checkpoint 0.2 & job=$!; tries=0; "
              "until test -e out.exr.checkpoint || test $tries = 600; do sleep 0.1; "
              "tries=$((tries + 1)); done; "
              "kill -TERM $(cat /proc/$job/task/*/children | tr ' ' '\n' | grep . | tail -n 1); "
              "wait $job");
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    EXPECT_NE(result.errors.find("--resume goes on"), std::string::npos) << result.errors;
    ASSERT_TRUE(std::filesystem::exists(folder / "out.exr.checkpoint"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

TEST_F(Mpi, CellsOfAStudyAreSharedOut) {
    put("study.toml", "[study]\nscene = \"scene.toml\"\n[render]\nspp = 2\n[measure]\n"
                      "[[sweep]]\nkey = \"material.grey.substrate.reflectance\"\n"
                      "values = [0.2, 0.5, 1.5, 0.8]\n");
    EXPECT_EQ(run("study study.toml -o one").exit_code, 1) << "a cell fails";
    const ProgramResult result = run_ranks(2, "study study.toml -o many --json out.json");
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    EXPECT_EQ(json("out.json").at("failed"), 1);
    EXPECT_EQ(json("out.json").at("results").size(), 4u);
    EXPECT_EQ(file_bytes(folder / "one/table.csv"), file_bytes(folder / "many/table.csv"));
    EXPECT_EQ(file_bytes(folder / "one/contact-sheet.png"),
              file_bytes(folder / "many/contact-sheet.png"));
}

TEST_F(Mpi, ConvergeSharesTheReferenceAndTimesMethodsOneByOne) {
    const ProgramResult result =
        run_ranks(2, "converge scene.toml -o errors --methods auto,auto+comb:8 --time 0.3 "
                     "--spp-reference 400 --json out.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    ASSERT_EQ(json("out.json").at("methods").size(), 2u);
    EXPECT_EQ(result.output.find("kept"), std::string::npos) << result.output;
    ASSERT_EQ(
        run("converge scene.toml -o alone --methods auto --time 0.1 --spp-reference 400").exit_code,
        0);
    expect_equal("errors/reference.exr", "alone/reference.exr");
}

} // namespace reradiant
