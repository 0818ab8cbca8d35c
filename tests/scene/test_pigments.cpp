#include "tests/scene/scratch.h"

#include "host/spectral/matrix/kubelka_munk.h"
#include "reradiant/scene_file.h"

using namespace reradiant;
using namespace reradiant::testing;

namespace {

class Pigments : public Scratch {
protected:
    /// A lambert substrate whose keys stand from line 4 on.
    std::filesystem::path file(const std::string& keys) const {
        return write("m.toml", "[material]\n[material.substrate]\ntype = \"lambert\"\n" + keys);
    }
    Substrate substrate(const std::string& keys) const {
        return load_material(file(keys)).substrate;
    }
    void expect_error(const std::string& keys, int line, int column,
                      const std::string& message) const {
        const auto name = file(keys);
        const Caught error = error_of([&] { load_material(name); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_EQ(error.line, line) << error.text;
        EXPECT_EQ(error.column, column) << error.text;
        EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
    }
};

const std::string WHITE =
    "pigments = [ { absorption = 0.5, scattering = 20, concentration = 2 } ]\n";
const std::string DYE =
    "dyes = [ { absorption = { gaussian_nm = 450, sigma_nm = 25, scale = 4 }, emission = { "
    "gaussian_nm = 540, sigma_nm = 20 }, quantum_yield = 0.8, concentration = 0.5 } ]\n";

} // namespace

TEST_F(Pigments, AnOpaqueLayerIsAReflectance) {
    const Substrate white = substrate(WHITE);
    EXPECT_FALSE(white.is_fluorescent());
    EXPECT_EQ(white.reflectance(550.0),
              kubelka_munk_reflectance(1.0, 40.0, PigmentLayer::OPAQUE, 0.0));
}

TEST_F(Pigments, AThinLayerShowsItsBacking) {
    const Substrate thin = substrate(WHITE + "thickness = 0.01\nbacking = 0.3\n");
    EXPECT_EQ(thin.reflectance(550.0), kubelka_munk_reflectance(1.0, 40.0, 0.01, 0.3));
}

TEST_F(Pigments, ADyeGivesAMatrix) {
    const Substrate glowing = substrate(WHITE + DYE);
    ASSERT_TRUE(glowing.matrix);
    EXPECT_TRUE(glowing.is_fluorescent());
    EXPECT_EQ(glowing.matrix->emission, grid_from_range(300.0, 780.0, 5.0));
    EXPECT_GT(glowing.matrix->values(glowing.matrix->emission.band_of(540.0),
                                     glowing.matrix->excitation.band_of(450.0)),
              0.0);
    // At 700 nm the dye neither absorbs nor emits, and only the pigment is left.
    EXPECT_NEAR(glowing.reflectance(700.0),
                kubelka_munk_reflectance(1.0, 40.0, PigmentLayer::OPAQUE, 0.0), 1e-9);
    // Without emission, or without any of it, the dye absorbs and nothing more.
    for (const char* change : {"quantum_yield = 0.0", "quantum_yield = 0.8, concentration = 0.0"}) {
        const Substrate dark =
            substrate(WHITE + replaced(DYE,
                                       std::string(change).find("conc") == std::string::npos
                                           ? "quantum_yield = 0.8"
                                           : "quantum_yield = 0.8, concentration = 0.5",
                                       change));
        EXPECT_FALSE(dark.is_fluorescent());
        EXPECT_FALSE(dark.matrix);
    }
}

TEST_F(Pigments, ConcentrationsFollowTextures) {
    const auto name =
        write("m.toml", "[[texture]]\nname = \"spots\"\ntype = \"noise\"\n[material]\n"
                        "[material.substrate]\ntype = \"lambert\"\n" +
                            WHITE +
                            replaced(DYE, "concentration = 0.5",
                                     "concentration = { texture = \"spots\", high = 1 }"));
    // A material file stands at the middle: the dye of ADyeGivesAMatrix.
    EXPECT_EQ(load_material(name).substrate.matrix->values, substrate(WHITE + DYE).matrix->values);
}

TEST_F(Pigments, WrongKeysAreRefusedAtTheirPlace) {
    expect_error(WHITE + "reflectance = 0.5\n", 5, 1, "both reflectance and pigments");
    expect_error("thickness = 1\n", 4, 1, "only a substrate of pigments");
    expect_error(WHITE + "backing = 0.5\n", 5, 1, "hides its backing");
    expect_error(WHITE + "thickness = -1\n", 5, 1, "at least 0");
    expect_error(WHITE + "thickness = 1\nbacking = 1.5\n", 6, 1, "at most 1");
    expect_error("pigments = [ { absorption = -1, scattering = 1 } ]\n", 4, 16, "at least 0");
    expect_error("pigments = [ { absorption = 1 } ]\n", 4, 14, "has no \"scattering\"");
    expect_error("pigments = [ { absorption = 1, scattering = 1, yield = 1 } ]\n", 4, 48,
                 "unknown key \"yield\"");
    expect_error("pigments = [ { absorption = 1, scattering = 1, concentration = -1 } ]\n", 4, 48,
                 "at least 0");
    expect_error("pigments = [ { absorption = 0, scattering = 0 } ]\n", 4, 1,
                 "neither absorbs nor scatters");
    expect_error(WHITE + replaced(DYE, "0.8", "1.1"), 5, 123, "at most 1");
    expect_error(WHITE + "dyes = [ { absorption = 1, emission = 0 } ]\n", 5, 28,
                 "emission is zero");
}
