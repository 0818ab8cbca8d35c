#include "tests/tools/program_runner.h"

namespace reradiant {

namespace {

using CommandLine = ProgramTest;

const char* const commands[] = {"render", "measure",  "synth",    "fit",     "colour",  "study",
                                "view",   "converge", "classify", "compare", "merge",   "validate",
                                "info",   "convert",  "check",    "devices", "develop", "probe"};

} // namespace

TEST_F(CommandLine, UnknownOrMissingCommandListsThoseThatExist) {
    for (const char* arguments : {"", "paint", "sculpt"}) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 2) << arguments;
        for (const char* command : commands)
            EXPECT_NE(result.errors.find(command), std::string::npos) << result.errors;
    }
}

TEST_F(CommandLine, EveryCommandsHelpEndsWithAnExample) {
    for (const std::string command : commands) {
        const ProgramResult result = run(command + " --help");
        EXPECT_EQ(result.exit_code, 0) << command;
        EXPECT_EQ(result.errors, "") << command;
        const std::size_t last_line = result.output.find_last_of('\n', result.output.size() - 3);
        EXPECT_NE(result.output.find("reradiant " + command + " ", last_line), std::string::npos)
            << result.output;
        for (const char* option :
             {"--device", "--seed", "--threads", "--json", "--quiet", "--verbose", "--version"})
            EXPECT_NE(result.output.find(option), std::string::npos) << command << " " << option;
    }
}

TEST_F(CommandLine, VersionNamesProgramAndLibraries) {
    for (const char* arguments : {"--version", "render --version"}) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0);
        for (const char* name : {"reradiant", "OpenEXR", "OpenColorIO"})
            EXPECT_NE(result.output.find(name), std::string::npos) << result.output;
    }
}

TEST_F(CommandLine, BadOptionsAreRefusedBeforeAnythingRuns) {
    put("scene.toml", small_scene());
    for (const char* arguments :
         {"compare", "compare a.exr", "info --colour a.exr", "info", "render",
          "render scene.toml -o out.exr --seed -1", "render scene.toml -o out.exr --seed many",
          "render scene.toml -o out.exr --threads -2", "render scene.toml -o out.exr --spp 0",
          "info scene.toml --quiet --verbose", "compare a.exr b.exr --max-relmse -1",
          "--seed 3 info scene.toml"})
        expect_failure(2, arguments, "reradiant: ");
}

} // namespace reradiant
