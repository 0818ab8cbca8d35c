// `view` as its users meet it: what it writes, and what it refuses.
#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

namespace reradiant {

namespace {

class ViewCommand : public ProgramTest {
protected:
    void SetUp() override {
        put("grey.toml", "[material]\nname = \"grey <b>\"\n[material.substrate]\ntype = "
                         "\"lambert\"\nreflectance = 0.5\n");
        put("dyed.toml", "[material]\n[[material.layer]]\nior = 1.5\n"
                         "[[material.layer.fluorophores]]\nabsorption = 1\n"
                         "emission = { gaussian_nm = 600, sigma_nm = 20, scale = 1 }\n"
                         "quantum_yield = 0.5\n[material.substrate]\ntype = \"lambert\"\n");
        put("lamp.csv", "nm,value\n300,1\n800,1\n");
    }
};

} // namespace

TEST_F(ViewCommand, WritesPageAndFilesAndSaysTheirSizes) {
    const ProgramResult result =
        run("view grey.toml -o page.html --glsl grey.glsl --osl grey.osl --materialx grey.mtlx "
            "--mitsuba grey.xml --lamp lamp.csv --json view.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const auto json = nlohmann::json::parse(file_bytes(folder / "view.json"));
    EXPECT_EQ(json.at("materials"), 1);
    for (const char* file : {"page.html", "grey.glsl", "grey.osl", "grey.mtlx", "grey.xml"}) {
        EXPECT_EQ(json.at("bytes").at(file), file_bytes(folder / file).size());
        EXPECT_NE(result.output.find(file), std::string::npos);
    }
    EXPECT_NE(file_bytes(folder / "grey.osl").find("under lamp.csv"), std::string::npos);
    const std::string page = file_bytes(folder / "page.html");
    EXPECT_NE(page.find("<title>grey &lt;b&gt;</title>"), std::string::npos);
    EXPECT_EQ(page.find("grey <b>"), std::string::npos);
}

TEST_F(ViewCommand, SeveralMaterialsShareAPage) {
    const ProgramResult result =
        run("view grey.toml --preset neon-orange-bare --illuminant FL11 -o page.html --quiet");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_NE(file_bytes(folder / "page.html").find("<title>grey &lt;b&gt;, neon-orange-bare"),
              std::string::npos);
}

TEST_F(ViewCommand, GalleryHoldsThePresetsAndNamesThoseLeftOut) {
    const ProgramResult result = run("view --gallery -o gallery.html --json gallery.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const auto json = nlohmann::json::parse(file_bytes(folder / "gallery.json"));
    EXPECT_GE(json.at("materials").get<int>(), 40);
    EXPECT_NE(result.errors.find("red-foil-concentrator"), std::string::npos) << result.errors;
    EXPECT_LT(json.at("bytes").at("gallery.html").get<int>(), 1500000);
}

TEST_F(ViewCommand, RefusesWhatCannotBe) {
    const std::pair<const char*, const char*> refusals[] = {
        {"view -o page.html", "MATERIAL.toml or a --preset"},
        {"view grey.toml", "nothing is asked for"},
        {"view grey.toml --gallery -o page.html", "leave the material out"},
        {"view grey.toml --preset brass --osl brass.osl", "name one alone"},
        {"view grey.toml --illuminant D65,A --glsl grey.glsl", "name one alone"},
        {"view --gallery --osl all.osl", "name one alone"},
        {"view missing.toml -o page.html", "missing.toml"},
        {"view grey.toml --illuminant D66 -o page.html", "--illuminant"},
        {"view grey.toml --lamp missing.csv -o page.html", "missing.csv"},
        {"view --preset gras -o page.html", "no preset is called 'gras'"},
        {"view dyed.toml --glsl dyed.glsl", "dyed.toml:1:1"},
        {"view dyed.toml --osl dyed.osl", "dyed.toml:1:1"},
        {"view --preset phosphor-sheet -o page.html", "phosphor-sheet.toml"},
        {"view grey.toml -o page.png", "page.png"},
        {"view grey.toml --materialx grey.xml", "use --mitsuba grey.xml for that"},
        {"view grey.toml --osl same.osl --glsl same.osl", "same.osl"},
        {"view grey.toml -o nowhere/page.html", "nowhere"},
        {"view grey.toml --illuminant L:700:2 --osl grey.osl", "no white"},
    };
    for (const auto& [arguments, words] : refusals)
        expect_failure(2, arguments, words);
}

TEST_F(ViewCommand, MistakesInAMaterialAreAtTheirPlace) {
    put("wrong.toml", "[material]\nname = \"x\"\ncolour = 3\n[material.substrate]\ntype = "
                      "\"lambert\"\n");
    expect_failure(2, "view wrong.toml -o page.html", "wrong.toml:3:1");
}

TEST_F(ViewCommand, WritesNothingOverWhatItReads) {
    put("page.html", "[material]\n[material.substrate]\ntype = \"lambert\"\n");
    expect_failure(2, "view page.html -o page.html", "write over what is read");
}

} // namespace reradiant
