#include "reradiant/scene_file.h"
#include "tests/scene/scratch.h"

#include <cmath>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

/// Materials of one layer (its keys stand from line 3 on) over a substrate.
class StackKeys : public Scratch {
protected:
    Material material(const std::string& layer, const std::string& substrate) const {
        return load_material(write("m.toml", text(layer, substrate)));
    }
    /// The error of a layer key, which must be placed at line 3 and this column.
    void expect_layer_error(const std::string& layer, int column,
                            const std::string& message) const {
        expect_error(text(layer, "type = \"lambert\""), 3, column, message);
    }
    void expect_error(const std::string& content, int line, int column,
                      const std::string& message) const {
        const auto file = write("m.toml", content);
        const Caught error = error_of([&] { load_material(file); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_EQ(error.line, line) << error.text;
        EXPECT_EQ(error.column, column) << error.text;
        EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
    }

    static std::string text(const std::string& layer, const std::string& substrate) {
        return "[material]\n[[material.layer]]\n" + layer + "\n[material.substrate]\n" + substrate +
               "\n";
    }
};

} // namespace

TEST_F(StackKeys, AMetalIsATableOfItsName) {
    const Substrate gold = material("ior = 1.5", "type = \"conductor\"\nmetal = \"gold\"\n"
                                                 "roughness_deg = 4\ndistribution = \"blinn\"")
                               .substrate;
    EXPECT_EQ(gold.type, SubstrateType::Conductor);
    // Johnson and Christy 1972, table I.
    EXPECT_EQ(gold.conductor.ior(582.1), 0.29);
    EXPECT_EQ(gold.conductor.kappa(582.1), 2.863);
    EXPECT_EQ(gold.conductor.distribution, Distribution::Blinn);
    EXPECT_EQ(gold.conductor.alpha, alpha_from_roughness_deg(Distribution::Blinn, 4.0));
}

TEST_F(StackKeys, EveryMetalReflectsAsMetalsDo) {
    const std::vector<std::pair<std::string, double>> reflectance_at_650{
        {"gold", 0.96},      {"silver", 0.99},      {"copper", 0.93},         {"aluminium", 0.906},
        {"seed-gold", 0.94}, {"seed-silver", 0.97}, {"seed-aluminium", 0.90},
    };
    for (const auto& [metal, expected] : reflectance_at_650) {
        const Conductor c = material("ior = 1.5", "type = \"conductor\"\nmetal = \"" + metal + "\"")
                                .substrate.conductor;
        const double n = c.ior(650.0), k = c.kappa(650.0);
        const double reflectance =
            ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k); // at normal incidence
        // Handbook values of evaporated films differ by about 0.02 among each other.
        EXPECT_NEAR(reflectance, expected, 0.02) << metal;
        EXPECT_LE(c.ior.data_from_nm(), 300.0) << metal;
        EXPECT_GE(c.ior.data_to_nm(), 780.0) << metal;
    }
}

TEST_F(StackKeys, FilmsFlakesAndScatteringAreRead) {
    const Layer layer = material("ior = 1.4\nscattering_coefficient = 2\nanisotropy = -0.5\n"
                                 "film = { thickness_nm = 250, ior = 1.8 }\n"
                                 "flakes = { coverage = 0.3, metal = \"silver\", alpha = 0.1, "
                                 "film = { thickness_nm = 90, ior = 2.4 } }",
                                 "type = \"lambert\"")
                            .stack.layers.at(0);
    EXPECT_EQ(layer.scattering_coefficient(500.0), 2.0);
    EXPECT_EQ(layer.anisotropy, -0.5);
    ASSERT_TRUE(layer.film && layer.flakes && layer.flakes->reflector.film);
    EXPECT_EQ(layer.film->thickness_nm, 250.0);
    EXPECT_EQ(layer.film->ior(500.0), 1.8);
    EXPECT_EQ(layer.flakes->coverage, 0.3);
    EXPECT_EQ(layer.flakes->reflector.alpha, 0.1);
    EXPECT_EQ(layer.flakes->reflector.film->thickness_nm, 90.0);
}

TEST_F(StackKeys, AbsorptionsByRgbMayExceedOne) {
    const Spectrum absorption =
        material("ior = 1.5\nabsorption = { rgb = [0.5, 4, 2] }", "type = \"lambert\"")
            .stack.layers.at(0)
            .absorption;
    EXPECT_GT(absorption(540.0), 3.0);
    EXPECT_LE(absorption.maximum(380.0, 780.0), 4.0);
    expect_error(text("ior = 1.5", "type = \"lambert\"\nreflectance = { rgb = [0.5, 4, 2] }"), 6, 1,
                 "at most 1");
}

TEST_F(StackKeys, LayersOutOfPhysicalRangeAreRefused) {
    expect_layer_error("ior = 0", 1, "above 0");
    expect_layer_error("ior = -1.5", 1, "above 0");
    expect_layer_error("ior = 200", 1, "at most 100");
    expect_layer_error("ior = nan", 1, "ior is nan");
    expect_layer_error("ior = { nm = [400, 700], value = [1.5, 0] }", 1, "goes down to 0");
    expect_error(text("ior = 1.5\nanisotropy = 1", "type = \"lambert\""), 4, 1, "below 1");
    expect_error(text("ior = 1.5\nanisotropy = -1", "type = \"lambert\""), 4, 1, "above -1");
    expect_error(text("ior = 1.5\nscattering_coefficient = -0.1", "type = \"lambert\""), 4, 1,
                 "at least 0");
    expect_error(text("ior = 1.5\nfilm = { thickness_nm = -1, ior = 1.3 }", "type = \"lambert\""),
                 4, 10, "at least 0");
    expect_error(text("ior = 1.5\nfilm = { thickness_nm = 100 }", "type = \"lambert\""), 4, 8,
                 "has no \"ior\"");
    expect_error(text("ior = 1.5\nfilm = { thickness = 100, ior = 1.3 }", "type = \"lambert\""), 4,
                 10, "did you mean \"thickness_nm\"?");
    expect_error(
        text("ior = 1.5\nflakes = { coverage = 1.1, metal = \"gold\" }", "type = \"lambert\""), 4,
        12, "at most 1");
    expect_error(text("ior = 1.5\nflakes = { metal = \"gold\" }", "type = \"lambert\""), 4, 10,
                 "has no \"coverage\"");
    expect_error(text("ior = 1.5\nflakes = { coverage = 0.1, ior = 1.1 }", "type = \"lambert\""), 4,
                 28, "no kappa");
}

TEST_F(StackKeys, MetalsWithoutKappaAndUnknownOnesAreRefused) {
    const auto refused = [&](const std::string& keys, int line, const std::string& message) {
        expect_error(text("ior = 1.5", "type = \"conductor\"\n" + keys), line, 1, message);
    };
    refused("ior = 0.2", 6, "has no kappa");
    refused("kappa = 3", 6, "has no ior");
    refused("", 5, "has no ior");
    refused("ior = 0.2\nkappa = -3", 7, "at least 0");
    refused("ior = 0\nkappa = 3", 6, "above 0");
    refused("metal = \"unobtainium\"", 6, "there are: aluminium, copper, gold");
    refused("metal = \"gold\"\nkappa = 3", 7, "both metal and kappa");
    refused("reflectance = 0.5", 6, "unknown key \"reflectance\"");
}

TEST_F(StackKeys, SigmaIsRequiredAndBounded) {
    expect_error(text("ior = 1.5", "type = \"oren-nayar\""), 4, 1, "has no \"sigma\"");
    expect_error(text("ior = 1.5", "type = \"oren-nayar\"\nsigma = 1.6"), 6, 1, "at most 1.57");
    expect_error(text("ior = 1.5", "type = \"oren-nayar\"\nsigma = -0.1"), 6, 1, "at least 0");
    expect_error(text("ior = 1.5", "type = \"lambert\"\nsigma = 0.1"), 6, 1,
                 "unknown key \"sigma\"");
}

TEST_F(StackKeys, MoreLayersThanSupportedAreRefused) {
    std::string layers;
    for (int i = 0; i < 65; ++i)
        layers += "[[material.layer]]\nior = 1.5\n";
    const std::string substrate = "[material.substrate]\ntype = \"lambert\"\n";
    const auto file = write("m.toml", "[material]\n" + layers + substrate);
    const Caught error = error_of([&] { load_material(file); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_EQ(error.line, 2) << error.text;
    EXPECT_NE(error.text.find("65 layers"), std::string::npos) << error.text;
}

TEST_F(StackKeys, AddingIsRefusedForMirrors) {
    const auto with_model = [&](const std::string& rest) {
        return "[material]\nmodel = \"adding\"\n" + rest;
    };
    expect_error(with_model("substrate = { type = \"conductor\", metal = \"gold\" }\n"), 2, 1,
                 "adding does not know conductors");
    expect_error(
        with_model("layer = [ { ior = 1.5, flakes = { coverage = 0.1, metal = \"gold\" } } "
                   "]\nsubstrate = { type = \"lambert\" }\n"),
        2, 1, "adding does not know flakes");
}
