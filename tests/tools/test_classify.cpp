#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

namespace reradiant {

namespace {

using Json = nlohmann::json;

class Classify : public ProgramTest {
protected:
    /// Runs `classify` with these answers and returns its JSON. "R", "B", "S", "O" stand for the
    /// questions in the tree's order, lower case for no.
    Json classified(const std::string& answers) const {
        std::string arguments = "classify --quiet --json result.json";
        for (const char answer : answers) {
            const bool yes = answer < 'a';
            const char question = yes ? answer : static_cast<char>(answer - 'a' + 'A');
            arguments += question == 'R'   ? " --reflects-environment"
                         : question == 'B' ? " --environment-blurred"
                         : question == 'S' ? " --highlight-small"
                                           : " --one-highlight";
            arguments += yes ? " yes" : " no";
        }
        const ProgramResult result = run(arguments + " </dev/null");
        EXPECT_EQ(result.exit_code, 0) << arguments << "\n" << result.errors;
        return Json::parse(file_bytes(folder / "result.json"));
    }
};

} // namespace

TEST_F(Classify, EveryLeafOfTheTreeIsReached) {
    struct Leaf {
        const char *answers, *top, *base, *letters;
    };
    for (const Leaf& leaf : {
             Leaf{"RB", "smooth", "metallic, smooth", "d"},
             Leaf{"RbS", "smooth", "metallic, smooth", "d"},
             Leaf{"RbsO", "rough", "metallic, smooth", "f"},
             Leaf{"Rbso", "rough", "metallic, rough", "gh"},
             Leaf{"rS", "smooth", "coloured surface", "ab"},
             Leaf{"rsO", "rough", "metallic, smooth", "f"},
             Leaf{"rso", "rough", "metallic, rough", "gh"},
         }) {
        const Json json = classified(leaf.answers);
        EXPECT_EQ(json.at("top"), leaf.top) << leaf.answers;
        EXPECT_EQ(json.at("base"), leaf.base) << leaf.answers;
        std::string letters;
        for (const Json& c : json.at("classes"))
            letters += c.at("letter").get<std::string>();
        EXPECT_EQ(letters, leaf.letters) << leaf.answers;
        EXPECT_EQ(json.at("preset"), json.at("classes")[0].at("presets")[0]);
    }
}

TEST_F(Classify, EveryClassHasPresetsThatAreThereAndAMaterialToStartFrom) {
    for (const char letter : std::string("abcdefgh")) {
        const ProgramResult result =
            run(std::string("classify --json c.json -o start.toml --class ") + letter);
        ASSERT_EQ(result.exit_code, 0) << result.errors;
        const Json json = Json::parse(file_bytes(folder / "c.json"));
        EXPECT_EQ(file_bytes(folder / "start.toml"), json.at("material").get<std::string>());
        EXPECT_EQ(run("validate start.toml").exit_code, 0) << letter;
        for (const Json& preset : json.at("classes")[0].at("presets")) {
            const std::string file = "'" RERADIANT_SOURCE_DIR "/spectra/materials/" +
                                     preset.get<std::string>() + ".toml'";
            EXPECT_EQ(run("info " + file).exit_code, 0) << preset;
        }
    }
}

TEST_F(Classify, TheMaterialIsPrintedWhenNoFileIsNamed) {
    const ProgramResult result =
        run("classify --reflects-environment no --highlight-small yes </dev/null");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    for (const char* text : {"class a: glossy paint", "class b", "start from: glossy-paint",
                             "[[material.layer]]", "roughness_deg"})
        EXPECT_NE(result.output.find(text), std::string::npos) << result.output;
}

TEST_F(Classify, BadMissingAndContradictoryAnswersAreRefused) {
    expect_failure(2, "classify </dev/null", "--reflects-environment is not answered");
    expect_failure(2, "classify --reflects-environment no </dev/null",
                   "--highlight-small is not answered");
    expect_failure(2, "classify --reflects-environment perhaps", "answer yes or no");
    // A wrong answer is refused wherever it stands: here the tree would not ask for it.
    expect_failure(2, "classify --reflects-environment no --highlight-small yes --one-highlight 2",
                   "--one-highlight is \"2\"");
    expect_failure(2,
                   "classify --reflects-environment no --environment-blurred yes "
                   "--highlight-small yes --json c.json -o m.toml",
                   "contradicts");
    expect_failure(2, "classify --class i", "--class");
    expect_failure(2, "classify --class a --one-highlight yes", "both --class and answers");
    expect_failure(2, "classify --class a -o missing/m.toml", "missing/m.toml");
}

TEST_F(Classify, AnswersThatAreNotAskedForAreSaidToBe) {
    const ProgramResult result = run("classify --reflects-environment yes --environment-blurred "
                                     "yes --one-highlight no </dev/null");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.errors.find("--one-highlight makes no difference"), std::string::npos)
        << result.errors;
}

TEST_F(Classify, HelpShowsTheTreeAndAnExample) {
    const ProgramResult result = run("classify --help");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.output.find("environment blurred?"), std::string::npos);
    const std::size_t last_line = result.output.find_last_of('\n', result.output.size() - 3);
    EXPECT_NE(result.output.find("reradiant classify ", last_line), std::string::npos);
}

} // namespace reradiant
