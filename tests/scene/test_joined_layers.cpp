// Layers of one medium that touch are one layer (cases 13 and 63).
#include "host/layers/stack/joined_layers.h"
#include "host/spectral/spectrum/same_spectrum.h"
#include "reradiant/scene_file.h"
#include "tests/scene/scratch.h"

using namespace reradiant;
using namespace reradiant::testing;

namespace {

class JoinedLayers : public Scratch {
protected:
    /// A material of layers, each given by its keys, over a substrate.
    static std::string text(const std::vector<std::string>& layers,
                            const std::string& bottom = "type = \"lambert\"\n") {
        std::string material = "[material]\n";
        for (const std::string& keys : layers)
            material += "[[material.layer]]\n" + keys + "\n";
        return material + "[material.substrate]\n" + bottom;
    }
    LayerStack stack(const std::vector<std::string>& layers,
                     const std::string& bottom = "type = \"lambert\"\n") const {
        return load_material(write("m.toml", text(layers, bottom))).stack;
    }
};

const std::string DYE = "fluorophores = [ { absorption = { gaussian_nm = 450, sigma_nm = 20 }, "
                        "emission = { gaussian_nm = 550, sigma_nm = 20 }";
const std::string COAT = "ior = 1.5\nabsorption = { nm = [400, 700], value = [1, 0] }\n" + DYE +
                         " } ]\nscattering_coefficient = 0.5\nanisotropy = 0.25\nthickness = ";

} // namespace

TEST_F(JoinedLayers, Case63NeighboursOfOneMediumAreOneSlab) {
    const LayerStack two = stack({COAT + "0.25", COAT + "0.5\nalpha = 0.3"});
    ASSERT_EQ(two.layers.size(), 1u);
    EXPECT_EQ(two.layers[0].thickness, 0.75);
    EXPECT_EQ(two.layers[0].alpha, 0.0) << "of the upper interface; the other does nothing";
    EXPECT_EQ(stack({COAT + "0.25\nalpha = 0.3", COAT + "0.5"}).layers[0].alpha, 0.3);
    EXPECT_EQ(stack({COAT + "1", COAT + "1", COAT + "1"}).layers.size(), 1u);
}

TEST_F(JoinedLayers, Case63MoreOfTheSameDyesIsMoreThickness) {
    const auto dyed = [](const std::string& concentration, const std::string& rest = "") {
        return "ior = 1.5\n" + rest + DYE + ", concentration = " + concentration + " } ]";
    };
    const LayerStack two = stack({dyed("0.5"), dyed("2")});
    ASSERT_EQ(two.layers.size(), 1u);
    EXPECT_EQ(two.layers[0].thickness, 5.0);
    EXPECT_EQ(stack({dyed("0.5", "absorption = 1\n"), dyed("2", "absorption = 1\n")}).layers.size(),
              2u)
        << "there is less dye in what else absorbs";
    EXPECT_EQ(stack({dyed("0.5"), dyed("0.5, quantum_yield = 0.9")}).layers.size(), 2u);
}

TEST_F(JoinedLayers, Case63ClearSlabsOfTheSameMediumAreNothing) {
    const std::string clear = "ior = 1.5\nthickness = 7";
    for (const std::vector<std::string>& layers :
         {std::vector{clear, COAT + "0.5"}, {COAT + "0.5", clear}, {clear, COAT + "0.5", clear}}) {
        const LayerStack joined = stack(layers);
        ASSERT_EQ(joined.layers.size(), 1u);
        EXPECT_EQ(joined.layers[0].thickness, 0.5);
        EXPECT_TRUE(joined.is_dyed());
    }
}

TEST_F(JoinedLayers, Case63WhatDiffersStaysApart) {
    const auto expect_two = [&](const std::string& below) {
        EXPECT_EQ(stack({COAT + "1", below}).layers.size(), 2u) << below;
    };
    expect_two(replaced(COAT + "1", "1.5", "1.6"));
    expect_two(replaced(COAT + "1", "[1, 0]", "[1, 0.1]"));
    expect_two(replaced(COAT + "1", "= 0.5", "= 0.6"));
    expect_two(replaced(COAT + "1", "0.25", "0.3"));
    expect_two(replaced(COAT + "1", "sigma_nm = 20 }, emission", "sigma_nm = 21 }, emission"));
    expect_two(COAT + "1\nfilm = { thickness_nm = 300, ior = 1.8 }");
    const std::string flakes = "\nflakes = { coverage = 0.1, metal = \"gold\" }";
    EXPECT_EQ(stack({COAT + "1" + flakes, COAT + "1"}).layers.size(), 2u);
    const LayerStack above = stack({COAT + "1", COAT + "1" + flakes});
    ASSERT_EQ(above.layers.size(), 1u);
    EXPECT_TRUE(above.layers[0].flakes.has_value());
}

TEST_F(JoinedLayers, Case13RoughnessBetweenEqualMediaIsNone) {
    const std::string other = "ior = 1.5\nabsorption = 3\nalpha = 0.4";
    EXPECT_TRUE(stack({COAT + "1", other}).is_smooth());
    EXPECT_FALSE(stack({COAT + "1", replaced(other, "1.5", "1.4")}).is_smooth());
    EXPECT_TRUE(stack({"ior = 1\nalpha = 0.4\nabsorption = 1"}).is_smooth());
    const std::string sheet = "type = \"none\"\n[material.back]\nalpha = 0.2\n";
    EXPECT_TRUE(stack({"ior = 1\nabsorption = 1"}, sheet).is_smooth());
    EXPECT_FALSE(stack({"ior = 1.1\nabsorption = 1"}, sheet).is_smooth());
}

TEST_F(JoinedLayers, Case63TexturedSurfacesAreJoinedWhereAllLevelsCanBe) {
    const auto scene = [&](const std::string& above, const std::string& below) {
        const std::string coats = "reflectance = 0.5\n[[material.layer]]\n" + above +
                                  "\n[[material.layer]]\n" + below +
                                  "\n[[texture]]\nname = \"t\"\ntype = \"checker\"\n";
        return load_scene(write("scene.toml", replaced(SMALL_SCENE, "reflectance = 0.5", coats)));
    };
    const std::string textured = "{ texture = \"t\", low = 0.5, high = 2 }";
    const std::string amount = "ior = 1.5\nabsorption = " + textured;
    const Scene same = scene(amount, amount);
    const auto first = static_cast<std::size_t>(same.surfaces[0].first_material);
    for (std::size_t level = 0; level < 2; ++level) {
        ASSERT_EQ(same.materials.at(first + level).stack.layers.size(), 1u);
        EXPECT_EQ(same.materials[first + level].stack.layers[0].thickness, 2.0);
    }
    // at one level both hold the same, at the other they do not
    const Scene other = scene(amount, "ior = 1.5\nabsorption = 0.5");
    for (std::size_t level = 0; level < 2; ++level)
        EXPECT_EQ(other.materials.at(first + level).stack.layers.size(), 2u);
}

TEST_F(JoinedLayers, SpectraAreTheSameWhereTheirValuesAre) {
    const auto table = [](double value) {
        return Spectrum::table({400.0, 403.3, 700.0}, {1.0, value, 0.0});
    };
    EXPECT_TRUE(same_spectrum(table(2.0), table(2.0)));
    EXPECT_FALSE(same_spectrum(table(2.0), table(2.0 + 1e-15)));
    EXPECT_FALSE(same_spectrum(Spectrum::line(405.0, 2.0, 1.0), Spectrum::line(405.0, 3.0, 1.0)));
    EXPECT_TRUE(same_spectrum(Spectrum(), Spectrum::constant(0.0)));
    EXPECT_FALSE(same_spectrum(Spectrum::constant(1.0), Spectrum::constant(1.5)));
    EXPECT_FALSE(same_spectrum(Spectrum::gaussian(503.0, 0.5, 1.0), Spectrum()));
}
