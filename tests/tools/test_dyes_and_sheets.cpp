// Dyes in layers and sheets, as users of the program meet them.
#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

namespace reradiant {

namespace {

using Json = nlohmann::json;

class DyesAndSheets : public ProgramTest {
protected:
    /// The text is refused at the place by all that reads materials, with code 2 and no file.
    void expect_material_refused(const std::string& text, const std::string& place) const {
        put("m.toml", text);
        for (const char* arguments : {"measure m.toml -o out.csv", "colour m.toml --json out.json",
                                      "validate m.toml", "info m.toml --json out.json"})
            expect_failure(2, arguments, place);
    }
    Json info(const std::string& file) const {
        const ProgramResult result = run("info " + file + " --json info.json");
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return Json::parse(file_bytes(folder / "info.json"));
    }
};

/// A dye in a varnish; keys of the dye stand from line 5 on, the substrate's in lines 8 and 9.
const std::string dyed = "[material]\n"
                         "[[material.layer]]\n"
                         "ior = 1.5\n"
                         "[[material.layer.fluorophores]]\n"
                         "absorption = { line_nm = 450, width_nm = 40, scale = 40 }\n"
                         "emission = { line_nm = 550, width_nm = 40, scale = 1 }\n"
                         "[material.substrate]\n"
                         "type = \"lambert\"\n"
                         "reflectance = 0.5\n";
const std::string sheet = replaced(dyed, "type = \"lambert\"\nreflectance = 0.5\n",
                                   "type = \"none\"\n[material.back]\nalpha = 0.1\n");

/// The small scene with one of these as its material, whose keys stand from line 15 on.
std::string scene_with(const std::string& material) {
    std::string text = small_scene();
    text.erase(text.find("[[material]]"));
    const std::string head = "[[material]]\nname = \"grey\"";
    return text + replaced(material, "[material]", head);
}

} // namespace

TEST_F(DyesAndSheets, InfoNamesTheDyesAndTheSheet) {
    put("dyed.toml", dyed);
    put("sheet.toml", sheet);
    put("pale.toml", replaced(dyed, "absorption", "concentration = 0\nabsorption"));
    const Json varnish = info("dyed.toml");
    EXPECT_EQ(varnish.at("dyes").at("count"), 1);
    EXPECT_EQ(varnish.at("dyes").at("absorb"), "430 to 470 nm");
    EXPECT_EQ(varnish.at("dyes").at("emit"), "530 to 570 nm");
    EXPECT_EQ(varnish.at("fluorescent"), true);
    EXPECT_EQ(varnish.at("sheet"), false);
    EXPECT_FALSE(varnish.contains("lower_face"));
    const Json foil = info("sheet.toml");
    EXPECT_EQ(foil.at("sheet"), true);
    EXPECT_EQ(foil.at("substrate"), "none");
    EXPECT_EQ(foil.at("lower_face"), "ggx, alpha 0.1, multiple");
    const Json pale = info("pale.toml");
    EXPECT_EQ(pale.at("fluorescent"), false);
    EXPECT_EQ(pale.at("dyes").at("absorb"), "nothing");
    EXPECT_EQ(run("validate sheet.toml").exit_code, 0);
    EXPECT_FALSE(info(RERADIANT_SOURCE_DIR "/spectra/materials/sugar.toml").contains("dyes"));
}

TEST_F(DyesAndSheets, BadDyesAreRefusedAtTheirKey) {
    const auto with = [](const std::string& from, const std::string& to) {
        return replaced(dyed, from, to);
    };
    expect_material_refused(with("emission", "concentration = -1\nemission"),
                            "m.toml:6:1: concentration is -1");
    expect_material_refused(with("scale = 40", "scale = -40"), "m.toml:5:");
    expect_material_refused(with("emission", "emision"), "m.toml:6:1: unknown key \"emision\"");
    expect_material_refused(with("emission", "quantum_yield = 2\nemission"),
                            "m.toml:6:1: quantum_yield is 2");
    expect_material_refused(with("emission = {", "emission = 0 #"), "m.toml:6:1: emission is zero");
    expect_material_refused(with("emission", "shares = { file = \"p.csv\" }\nemission"),
                            "m.toml:7:1: both shares and emission");
    expect_material_refused(with("[material]\n", "[material]\nmodel = \"weidlich-wilkie\"\n"),
                            "m.toml:2:1: weidlich-wilkie does not know dyes in layers: it follows "
                            "no light between the slabs");
}

TEST_F(DyesAndSheets, SharesThatBreakTheBalanceAreRefusedWithTheirColumn) {
    put("p.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                 "nm,400,500\n400,0.5,0\n500,0.501,0.5\n");
    const std::string emission = "emission = { line_nm = 550, width_nm = 40, scale = 1 }";
    const std::string text = replaced(dyed, emission, "shares = { file = \"p.csv\" }");
    expect_material_refused(text, "m.toml:6:12: the column of excitation 400 nm");
    put("p.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                 "nm,400,500\n400,0.5,0\n500,-0.1,0.5\n");
    expect_material_refused(text, "m.toml:6:12: the value -0.1 at excitation 400 nm");
}

TEST_F(DyesAndSheets, BadSheetsAreRefusedAtTheirKey) {
    expect_material_refused(replaced(sheet, "type = \"none\"\n", "type = \"none\"\nsigma = 0.3\n"),
                            "m.toml:9:1: the substrate is \"none\", and nothing has no sigma");
    expect_material_refused(replaced(sheet, "alpha = 0.1", "alpha = 3"), "m.toml:10:1: alpha is 3");
    expect_material_refused(dyed + "[material.back]\nalpha = 0.1\n",
                            "m.toml:10:11: only a sheet has a lower face");
    expect_material_refused("[material]\nsubstrate = { type = \"none\" }\n",
                            "m.toml:2:1: the substrate is \"none\" and there is no layer");
}

TEST_F(DyesAndSheets, CommandsRefuseModelsAndGeometriesThatCannotDoThem) {
    put("dyed.toml", dyed);
    put("sheet.toml", sheet);
    for (const char* file : {"dyed.toml", "sheet.toml"})
        expect_failure(2, "measure " + std::string(file) + " -o m.csv --model weidlich-wilkie",
                       std::string(file) + ":1:1: weidlich-wilkie does not know");
    for (const char* file : {"dyed.toml", "sheet.toml"})
        EXPECT_EQ(run("colour " + std::string(file) + " --geometry d/8").exit_code, 0) << file;
    expect_failure(2, "colour sheet.toml --geometry 45:180 --json c.json", "the far side");
}

TEST_F(DyesAndSheets, PicturesOfWhatTheRendererDoesNotKnowAreRefusedAtTheMaterial) {
    put("sheet.toml", scene_with(sheet));
    for (const std::string name : {"sheet", "dyed"}) {
        put("dyed.toml", scene_with(dyed));
        expect_failure(2, "render " + name + ".toml -o out.exr --wavelengths hero",
                       name + ".toml:15:1: ");
    }
    expect_failure(2, "render dyed.toml -o out.exr --model weidlich-wilkie", "dyed.toml:15:1: ");
}

TEST_F(DyesAndSheets, FitsLookThroughNeither) {
    put("recipe.toml", file_bytes(RERADIANT_SOURCE_DIR "/tools/examples/synth-varnished.toml"));
    ASSERT_EQ(run("synth recipe.toml -o data.csv").exit_code, 0);
    put("dyed.toml", dyed);
    expect_failure(2, "fit data.csv -o out.csv --stack dyed.toml",
                   "dyed.toml:4:18: dyes in layers");
    put("clear.toml", replaced(sheet, "absorption", "concentration = 0\nabsorption"));
    expect_failure(2, "fit data.csv -o out.csv --stack clear.toml",
                   "clear.toml:10:11: the layers are those of a sheet");
}

TEST_F(DyesAndSheets, SynthMeasuresThroughDyedLayersAndNoSheets) {
    const std::string recipe = "reflectance = 0.8\n"
                               "emission_nm = { from = 400, to = 700, step = 10 }\n"
                               "excitation_nm = { from = 400, to = 700, step = 10 }\n"
                               "[geometry]\ntheta_i_deg = [45]\ntheta_o_deg = [0]\n"
                               "phi_deg = [0]\n" +
                               replaced(dyed, "[material]\n", "");
    const std::size_t substrate = recipe.find("[material.substrate]");
    put("recipe.toml", recipe.substr(0, substrate));
    EXPECT_EQ(run("validate recipe.toml").exit_code, 0);
    const ProgramResult made = run("synth recipe.toml -o data.csv --json made.json");
    EXPECT_EQ(made.exit_code, 0) << made.errors;
    EXPECT_NE(made.output.find("dyes in 1 of the layers"), std::string::npos) << made.output;
    EXPECT_EQ(Json::parse(file_bytes(folder / "made.json")).at("dyed_layers"), 1);
    put("sheet.toml", recipe.substr(0, substrate) + "[material.back]\nalpha = 0.1\n");
    expect_failure(2, "synth sheet.toml -o data.csv", "a sheet has none");
    put("bare.toml", recipe);
    expect_failure(2, "synth bare.toml -o data.csv", "are the substrate");
}

TEST_F(DyesAndSheets, StudiesSweepDyesAndMeasureSheets) {
    put("dyed.toml", dyed);
    put("sheet.toml", sheet);
    const auto study = [&](const std::string& material, const std::string& target) {
        put("study.toml", "[study]\nmaterial = \"" + material + "\"\n[measure]\n[[sweep]]\n" +
                              target + "\nvalues = [0, 1]\n");
        return run("study study.toml -o out");
    };
    const ProgramResult swept =
        study("dyed.toml", "parameter = \"concentration\"\nlayer = 0\nfluorophore = 0");
    EXPECT_EQ(swept.exit_code, 0) << swept.errors;
    EXPECT_NE(file_bytes(folder / "out/table.csv").find("concentration"), std::string::npos);
    EXPECT_EQ(study("sheet.toml", "parameter = \"concentration\"").exit_code, 0);
    const std::string far_side = "[measure]\ntheta_o_deg = [150]\n[[sweep]]\n"
                                 "parameter = \"thickness\"\nvalues = [1, 2]\n";
    put("study.toml", "[study]\nmaterial = \"sheet.toml\"\n" + far_side);
    const ProgramResult measured = run("study study.toml -o far");
    EXPECT_EQ(measured.exit_code, 0) << measured.errors;
    EXPECT_NE(file_bytes(folder / "far/table.csv").find("45,150,0"), std::string::npos);
    put("study.toml", "[study]\nmaterial = \"dyed.toml\"\n" + far_side);
    expect_failure(2, "study study.toml -o other",
                   "study.toml:4:1: theta_o_deg of 150 degrees lies beneath the material");
}

// Two coats of one varnish give what one coat as thick as both gives, to the bit.
TEST_F(DyesAndSheets, Case63TwoCoatsAreOne) {
    const auto coats = [](const std::string& thicknesses_of_all) {
        const std::string coat =
            dyed.substr(dyed.find("[[material.layer]]"),
                        dyed.find("[material.substrate]") - dyed.find("[[material.layer]]"));
        return replaced(coat, "ior = 1.5\n", "ior = 1.5\nthickness = " + thicknesses_of_all + "\n");
    };
    const std::string substrate = dyed.substr(dyed.find("[material.substrate]"));
    put("two.toml", "[material]\n" + coats("0.25") + coats("0.5\nalpha = 0.3") + substrate);
    put("one.toml", "[material]\n" + coats("0.75") + substrate);
    for (const char* name : {"one", "two"}) {
        const std::string file = name;
        put(file + "-scene.toml", scene_with(file_bytes(folder / (file + ".toml"))));
        for (const std::string model : {"adding", "walk --samples 1000"})
            EXPECT_EQ(run("measure " + file + ".toml --hemispherical --theta-i 0,45 --model " +
                          model + " -o " + file + "-" + model.substr(0, 4) + ".csv")
                          .exit_code,
                      0);
        EXPECT_EQ(run("render " + file + "-scene.toml --spp 2 -o " + file + ".exr").exit_code, 0);
    }
    for (const std::string model : {"addi", "walk"})
        EXPECT_EQ(file_bytes(folder / ("one-" + model + ".csv")),
                  file_bytes(folder / ("two-" + model + ".csv")));
    EXPECT_EQ(run("compare one.exr two.exr --max-relmse 0").exit_code, 0);
}

/// The numbers of a stack stand for the files that its dyes name.
TEST_F(DyesAndSheets, AWalkDoesNotGoOnWithOtherShares) {
    const std::string head = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                             "nm,400,500\n400,0.5,0\n500,0.2,0.5\n";
    put("p.csv", head);
    put("m.toml", replaced(replaced(dyed, "nm = 450", "nm = 400"),
                           "emission = { line_nm = 550, width_nm = 40, scale = 1 }",
                           "shares = { file = \"p.csv\" }"));
    const std::string walk = "measure m.toml -o walk.csv --model walk --samples 2000000";
    ASSERT_EQ(run_until("walk.csv.checkpoint", walk + " --checkpoint 0.05"), 130);
    put("p.csv", replaced(head, "500,0.2", "500,0.3"));
    expect_failure(2, walk + " --resume", "the checkpoint is of other work: the stack is");
}

} // namespace reradiant
