#include "reradiant/reradiation.h"
#include "reradiant/scene_file.h"
#include "tests/scene/scratch.h"

using namespace reradiant;
using namespace reradiant::testing;

using MaterialFile = Scratch;

namespace {

const char* const COATED = R"([material]
  [[material.layer]]
  ior = 1.5
  [material.substrate]
  type = "lambert"
  reradiation = { reflectance = 0.1, fluorophores = [
    { excitation = { gaussian_nm = 400, sigma_nm = 20, scale = 0.8 }, emission = { gaussian_nm = 600, sigma_nm = 15 }, quantum_yield = 0.9 } ] }
)";

void expect_error(const std::filesystem::path& file, int line, int column,
                  const std::string& message) {
    const Caught error = error_of([&] { load_material(file); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_EQ(error.line, line) << error.text;
    EXPECT_EQ(error.column, column) << error.text;
    EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
}

} // namespace

TEST_F(MaterialFile, DefaultsAreAsDocumented) {
    const Material material = load_material(write("coat.toml", COATED));
    EXPECT_EQ(material.name, "coat");
    EXPECT_EQ(material.model, Model::Auto);
    ASSERT_EQ(material.stack.layers.size(), 1u);
    const Layer& layer = material.stack.layers[0];
    EXPECT_EQ(layer.alpha, 0.0);
    EXPECT_EQ(layer.distribution, Distribution::Ggx);
    EXPECT_EQ(layer.scattering, Scattering::Multiple);
    EXPECT_EQ(layer.thickness, 1.0);
    EXPECT_EQ(layer.absorption(500.0), 0.0);
}

TEST_F(MaterialFile, FluorophoresAreRead) {
    const Substrate substrate = load_material(write("coat.toml", COATED)).substrate;
    ASSERT_EQ(substrate.fluorophores.size(), 1u);
    EXPECT_EQ(substrate.fluorophores[0].quantum_yield, 0.9);
    EXPECT_NEAR(substrate.fluorophores[0].excitation(400.0), 0.8, 1e-15);
    EXPECT_EQ(substrate.reflectance(500.0), 0.1);
    EXPECT_FALSE(substrate.matrix);
    EXPECT_TRUE(substrate.is_fluorescent());
}

TEST_F(MaterialFile, AMatrixFileGivesMatrixAndReflectance) {
    write("m.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                   "nm,400,410,420\n400,0.5,0,0\n410,0.1,0.4,0\n420,0.2,0.1,0.3\n");
    const Substrate substrate =
        load_material(write("m.toml", "[material]\nsubstrate = { type = \"lambert\", reradiation = "
                                      "{ file = \"m.csv\" } }\n"))
            .substrate;
    ASSERT_TRUE(substrate.matrix);
    EXPECT_EQ(substrate.reflectance(410.0), 0.4);
    EXPECT_EQ(substrate.matrix->values(2, 0), 0.2);
    EXPECT_TRUE(substrate.is_fluorescent());
}

TEST_F(MaterialFile, ErrorsAreAtTheirPlace) {
    expect_error(write("a.toml", replaced(COATED, "ior = 1.5", "ior = 0")), 3, 3, "above 0");
    expect_error(write("a.toml", replaced(COATED, "ior = 1.5", "alpha = 0.1")), 2, 3,
                 "has no \"ior\"");
    expect_error(
        write("a.toml", replaced(COATED, "ior = 1.5", "ior = 1.5\nalpha = 0.1\nroughness_deg = 3")),
        4, 1, "both roughness_deg and alpha");
    expect_error(write("a.toml", replaced(COATED, "ior = 1.5", "ior = 1.5\nroughness_deg = 90")), 4,
                 1, "below 90");
    expect_error(write("a.toml", replaced(COATED, "ior = 1.5", "ior = 1.5\nalpha = 1.5")), 4, 1,
                 "at most 1");
    expect_error(write("a.toml", replaced(COATED, "ior = 1.5", "ior = 1.5\nthickness = -1")), 4, 1,
                 "at least 0");
    expect_error(write("a.toml", replaced(COATED, "ior = 1.5", "ior = 1.5\nabsorption = -1")), 4, 1,
                 "at least 0");
    expect_error(
        write("a.toml", replaced(COATED, "ior = 1.5", "ior = 1.5\ndistribution = \"phong\"")), 4, 1,
        "blinn, beckmann, ggx");
    expect_error(write("a.toml", replaced(COATED, "type = \"lambert\"", "type = \"lambrt\"")), 5, 3,
                 "did you mean \"lambert\"?");
    expect_error(write("a.toml", replaced(COATED, "type = \"lambert\"",
                                          "type = \"lambert\"\nreflectance = 0.5")),
                 6, 1, "both reflectance and reradiation");
    expect_error(write("a.toml", replaced(COATED, "quantum_yield = 0.9", "quantum_yield = 1.1")), 7,
                 120, "at most 1");
    expect_error(write("a.toml", replaced(COATED, "gaussian_nm = 600, sigma_nm = 15",
                                          "nm = [500], value = [0]")),
                 7, 71, "emission is zero");
}

TEST_F(MaterialFile, FluorophoresThatBreakEnergyAreRefused) {
    const std::string text = replaced(COATED, "reflectance = 0.1", "reflectance = 0.7");
    expect_error(write("a.toml", text), 6, 3, "");
}

TEST_F(MaterialFile, ASceneIsNoMaterial) {
    const Caught error = error_of([&] { load_material(write("scene.toml", SMALL_SCENE)); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_EQ(error.line, 1) << error.text;
}

TEST_F(MaterialFile, SpectraUsedOutsideTheirDataAreWarnedAboutOnce) {
    const auto file = write("w.toml", "[material]\nsubstrate = { type = \"lambert\", reflectance = "
                                      "{ nm = [400, 700], value = [0.5, 0.6] } }\n");
    const auto warnings = warnings_of([&] { load_material(file); });
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("reflectance has data from 400 to 700 nm"), std::string::npos);
    EXPECT_NE(warnings[0].find("w.toml:2:"), std::string::npos) << warnings[0];
    EXPECT_TRUE(warnings_of([&] { load_material(write("c.toml", COATED)); }).empty());
}

TEST_F(MaterialFile, RepairsOfAMeasurementAreReported) {
    write("m.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                   "# kind: measured\nnm,400,410\n400,0.5,0.01\n410,-0.1,0.4\n");
    const auto file = write("m.toml", "[material]\nsubstrate = { type = \"lambert\", reradiation = "
                                      "{ file = \"m.csv\" } }\n");
    std::vector<std::string> warnings = warnings_of([&] {
        const Material material = load_material(file);
        EXPECT_EQ(material.substrate.matrix->values(1, 0), 0.0); // negative
        EXPECT_EQ(material.substrate.matrix->values(0, 1), 0.0); // anti-Stokes
    });
    ASSERT_FALSE(warnings.empty());
    EXPECT_NE(warnings[0].find("m.toml:2:"), std::string::npos) << warnings[0];
}
