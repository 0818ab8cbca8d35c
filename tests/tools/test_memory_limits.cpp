#include "tests/tools/program_runner.h"

namespace reradiant {

namespace {

class MemoryLimits : public ProgramTest {
protected:
    void SetUp() override {
        put("scene.toml", small_scene());
        put("study.toml", "[study]\npreset = \"red-lacquer\"\n[render]\nwidth = 8\nheight = 8\n"
                          "[[sweep]]\nparameter = \"thickness\"\nvalues = [1, 2]\n");
        put("data.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                        "# kind: measured\nnm,400,410,420\n400,0.5,0,0\n410,0.1,0.4,0\n"
                        "420,0.05,0.1,0.3\n");
        ASSERT_EQ(run("render scene.toml -o part.exr --sample-range 0:2").exit_code, 0);
    }
};

/// Every command that takes memory by what it is asked for.
const char* const commands[] = {
    "render scene.toml -o out.exr --spp 1",
    "render scene.toml -o out.exr --spp 1 --resume",
    "study study.toml -o out",
    "converge scene.toml -o out --time 1",
    "measure --preset red-lacquer -o out.csv",
    "measure --preset fluorescent-orange-bare -o out.csv --hemispherical",
    "fit data.csv -o out.csv --model matrix",
    "fit data.csv -o out.csv --rank 1",
    "compare part.exr part.exr",
    "merge part.exr -o out.exr",
};

} // namespace

TEST_F(MemoryLimits, Case36EveryCommandRefusesWhatIsOverItsLimitBeforeItWorks) {
    for (const std::string command : commands) {
        const ProgramResult result = run(command + " --memory-limit 1000");
        const bool study = command.starts_with("study"); // its cells fail, one by one
        EXPECT_EQ(result.exit_code, study ? 1 : 2) << command << "\n" << result.errors;
        EXPECT_NE(result.errors.find("the limit is 1000"), std::string::npos) << command << "\n"
                                                                              << result.errors;
        for (const char* output : {"out.exr", "out.csv"})
            EXPECT_FALSE(std::filesystem::exists(folder / output)) << command;
    }
}

// Grids that a slip of the pen asks for: matrices between 480,000 bands would be 1e13 bytes.
TEST_F(MemoryLimits, Case36AbsurdGridsAreRefusedByDefault) {
    expect_failure(2, "measure --preset red-lacquer -o out.csv --bands 300:780:0.001", "");
    expect_failure(2, "render scene.toml -o out.exr --bands 300:780:0.00001", "");
}

TEST_F(MemoryLimits, OrdinaryWorkIsFarBelowAGigabyte) {
    for (const std::string command : {commands[4], commands[6], commands[8], commands[9]})
        EXPECT_EQ(run(command + " --memory-limit 1000000000").exit_code, 0) << command;
}

} // namespace reradiant
