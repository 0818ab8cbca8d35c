// Long work other than renders: measurements by the walk, fits, cells of studies and methods that
// are interrupted and go on.
#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

namespace reradiant {

namespace {

class KeptWork : public ProgramTest {
protected:
    void SetUp() override {
        put("scene.toml", small_scene());
        put("coat.toml", material("0.3"));
    }
    static std::string material(const std::string& alpha) {
        return "[material]\n[[material.layer]]\nior = 1.5\nalpha = " + alpha +
               "\n[material.substrate]\ntype = \"lambert\"\nreflectance = 0.6\n";
    }
};

constexpr const char* walk =
    "measure coat.toml -o walk.csv --model walk --theta-i 10,45 --theta-o 20 --phi 180 "
    "--bands 400:700:50 --samples ";

} // namespace

TEST_F(KeptWork, WalkThatWasInterruptedEndsAsIfItHadNotBeen) {
    const std::string work = std::string(walk) + "200000";
    ASSERT_EQ(run(work).exit_code, 0);
    const std::string whole = file_bytes(folder / "walk.csv");
    std::filesystem::remove(folder / "walk.csv");
    ASSERT_EQ(run_until("walk.csv.checkpoint", work + " --checkpoint 0.05"), 130);
    EXPECT_FALSE(std::filesystem::exists(folder / "walk.csv"));
    const std::string kept = file_bytes(folder / "walk.csv.checkpoint");
    ASSERT_GT(kept.size(), 1000u);
    const ProgramResult resumed = run(work + " --resume");
    ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
    EXPECT_EQ(file_bytes(folder / "walk.csv"), whole);
    EXPECT_FALSE(std::filesystem::exists(folder / "walk.csv.checkpoint"));

    put("walk.csv.checkpoint", kept);
    expect_failure(2, std::string(walk) + "100000 --resume", "the samples is 100000, not 200000");
    put("coat.toml", material("0.4"));
    expect_failure(2, work + " --resume", "the checkpoint is of other work: the material is");
    put("walk.csv.checkpoint", kept.substr(0, kept.size() / 2));
    expect_failure(2, work + " --resume", "walk.csv.checkpoint: is no whole checkpoint");
}

// Kernels that are not in the cache take seconds to build, and nobody can ask them to stop.
TEST_F(KeptWork, RenderThatIsInterruptedBeforeItsFirstPassEndsAtOnce) {
    const std::string command =
        "cd '" + (folder / "").string() +
        "' && { XDG_CACHE_HOME=\"$PWD/cache\" '" RERADIANT_PROGRAM
        "' render scene.toml -o out.exr --spp 2 --quiet 2>errors & program=$!; "
        "until test -d cache/reradiant || ! kill -0 $program; do sleep 0.02; done; "
        "kill -TERM $program; { sleep 2; kill -KILL $program; } 2>/dev/null & wait $program; }";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 130) << "137: it had to be killed";
    EXPECT_NE(file_bytes(folder / "errors").find("interrupted while setting up"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

TEST_F(KeptWork, FitThatWasInterruptedEndsAsIfItHadNotBeen) {
    put("recipe.toml", file_bytes(RERADIANT_SOURCE_DIR "/tools/examples/synth-orange.toml"));
    ASSERT_EQ(run("synth recipe.toml -o data.csv --seed 1").exit_code, 0);
    const std::string work = "fit data.csv -o matrix.csv --model factors --rank 3 --json ";
    ASSERT_EQ(run(work + "whole.json").exit_code, 0);
    const std::string whole = file_bytes(folder / "matrix.csv");
    std::filesystem::remove(folder / "matrix.csv");
    ASSERT_EQ(run_until("matrix.csv.checkpoint", work + "part.json --checkpoint 1e-6"), 130);
    EXPECT_FALSE(std::filesystem::exists(folder / "matrix.csv"));
    const std::string kept = file_bytes(folder / "matrix.csv.checkpoint");
    const ProgramResult resumed = run(work + "resumed.json --resume");
    ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
    EXPECT_EQ(file_bytes(folder / "matrix.csv"), whole);
    const auto of = [&](const char* file, const char* key) {
        return nlohmann::json::parse(file_bytes(folder / file)).at(key);
    };
    EXPECT_EQ(of("resumed.json", "iterations"), of("whole.json", "iterations"));
    EXPECT_EQ(of("resumed.json", "kkt"), of("whole.json", "kkt"));
    put("matrix.csv.checkpoint", kept);
    expect_failure(2, "fit data.csv -o matrix.csv --model matrix --resume",
                   "the model is matrix, not factors");
}

TEST_F(KeptWork, CellOfAStudyGoesOnFromItsOwnRender) {
    put("study.toml", "[study]\nscene = \"scene.toml\"\n[render]\nspp = 60000\n"
                      "[[sweep]]\nkey = \"material.grey.substrate.reflectance\"\n"
                      "values = [0.5]\n");
    const std::string work = "study study.toml -o results --checkpoint 0.1";
    ASSERT_EQ(run_until("results/cells/0000/image.exr.checkpoint", work), 130);
    ASSERT_TRUE(std::filesystem::exists(folder / "results/cells/0000/image.exr.checkpoint"));
    const std::string kept = file_bytes(folder / "results/cells/0000/image.exr.checkpoint");
    // A checkpoint of another scene is refused where it must fit, and work is begun anew where it
    // need not.
    put("scene.toml", replaced(small_scene(), "radius = 1\n", "radius = 0.9\n"));
    expect_failure(2, work + " --resume", "the scene is");
    put("scene.toml", small_scene());
    ASSERT_EQ(run(work + " --resume").exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "results/cells/0000/image.exr.checkpoint"));
    put("scene.toml", small_scene());
    ASSERT_EQ(run("study study.toml -o whole").exit_code, 0);
    EXPECT_EQ(read_spectral_exr(folder / "results/cells/0000/image.exr").values,
              read_spectral_exr(folder / "whole/cells/0000/image.exr").values);
    std::filesystem::remove(folder / "results/cells/0000/cell.json");
    put("results/cells/0000/image.exr.checkpoint", kept);
    put("study.toml", replaced(file_bytes(folder / "study.toml"), "spp = 60000", "spp = 2"));
    put("scene.toml", replaced(small_scene(), "radius = 1\n", "radius = 0.9\n"));
    const ProgramResult anew = run(work);
    EXPECT_EQ(anew.exit_code, 0);
    EXPECT_NE(anew.errors.find("this render begins anew"), std::string::npos) << anew.errors;
}

TEST_F(KeptWork, MethodAndReferenceGoOnFromTheirOwnRenders) {
    const std::string work = "converge scene.toml -o errors --methods auto --time 1.5 "
                             "--spp-reference 60000 --checkpoint 0.1";
    ASSERT_EQ(run_until("errors/reference.exr.checkpoint", work), 130);
    ASSERT_TRUE(std::filesystem::exists(folder / "errors/reference.exr.checkpoint"));
    ASSERT_EQ(run_until("errors/methods/auto.exr.checkpoint", work + " --resume"), 130);
    ASSERT_TRUE(std::filesystem::exists(folder / "errors/methods/auto.rows.json"));
    const auto rows_of = [&](const std::string& file) {
        return nlohmann::json::parse(file_bytes(folder / file)).at("rows");
    };
    const auto before = rows_of("errors/methods/auto.rows.json");
    ASSERT_EQ(run(work + " --resume").exit_code, 0);
    const auto after = rows_of("errors/methods/auto.json");
    EXPECT_EQ(after.at(0).at("relmse"), before.at(0).at("relmse")) << "rows are kept";
    EXPECT_EQ(after.at(0).at("seconds"), before.at(0).at("seconds"));
    EXPECT_GE(after.back().at("seconds").get<double>(), 1.5);
    EXPECT_FALSE(std::filesystem::exists(folder / "errors/methods/auto.rows.json"));
    ASSERT_EQ(run("render scene.toml -o whole.exr --spp 60000 --seed 4294967295").exit_code, 0);
    EXPECT_EQ(read_spectral_exr(folder / "errors/reference.exr").values,
              read_spectral_exr(folder / "whole.exr").values);
}

} // namespace reradiant
