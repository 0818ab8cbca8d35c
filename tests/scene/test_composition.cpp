#include "tests/scene/scratch.h"

#include "reradiant/reradiation.h"
#include "reradiant/scene_file.h"

#include <cmath>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

/// What materials, files and meshes are put together of.
class Composition : public Scratch {
protected:
    /// The small scene with the table of its material, lines 10 to 14, written as `text`.
    std::filesystem::path scene_with(const std::string& text) {
        return write("scene.toml", replaced(SMALL_SCENE,
                                            "[[material]]\nname = \"grey\"\n[material.substrate]\n"
                                            "type = \"lambert\"\nreflectance = 0.5",
                                            text));
    }
    Scene read(const std::string& text) { return load_scene(scene_with(text)); }
    Caught refusal(const std::string& text) {
        return error_of([&] { read(text); });
    }
};

std::string mixture(const std::string& name, const std::string& with) {
    return "[[material]]\nname = \"" + name +
           "\"\nsubstrate = { type = \"lambert\" }\nmix = { with = \"" + with +
           "\", weight = 0.5 }\n";
}

const std::string GREY = "[[material]]\nname = \"grey\"\nsubstrate = { type = \"lambert\" }\n";

} // namespace

TEST_F(Composition, MixturesMayHoldMixtures) {
    const Scene scene = read(mixture("grey", "b") + mixture("b", "c") +
                             "[[material]]\nname = \"c\"\nsubstrate = { type = \"lambert\" }");
    EXPECT_EQ(scene.surfaces.at(0).mixed_with, 1);
    EXPECT_EQ(scene.surfaces.at(1).mixed_with, 2);
    EXPECT_EQ(scene.surfaces.at(2).mixed_with, -1);
}

TEST_F(Composition, MixturesThatHoldThemselvesAreRefusedAtTheirPlace) {
    const Caught circle = refusal(mixture("grey", "b") + mixture("b", "c") + mixture("c", "b"));
    EXPECT_EQ(circle.exit_code, 2);
    EXPECT_EQ(circle.line, 17) << circle.text; // b's own mix
    EXPECT_NE(circle.text.find("\"b\" with \"c\" with \"b\""), std::string::npos) << circle.text;
    EXPECT_EQ(refusal(mixture("grey", "grey")).line, 13);
}

TEST_F(Composition, KeysAreLaidOverAPreset) {
    const Scene scene = read("[[material]]\nname = \"grey\"\npreset = \"red-lacquer\"\n"
                             "layer = [{ thickness = 7 }]\n"
                             "[material.substrate]\nreflectance = 0.25");
    const Scene plain = read("[[material]]\nname = \"grey\"\npreset = \"red-lacquer\"");
    const Material &own = scene.materials.at(0), &preset = plain.materials.at(0);
    ASSERT_EQ(own.stack.layers.size(), preset.stack.layers.size());
    EXPECT_EQ(own.stack.layers[0].thickness, 7.0);
    EXPECT_NE(preset.stack.layers[0].thickness, 7.0);
    EXPECT_EQ(own.stack.layers[0].ior(550.0), preset.stack.layers[0].ior(550.0));
    EXPECT_EQ(own.stack.layers[0].alpha, preset.stack.layers[0].alpha);
    EXPECT_EQ(own.substrate.reflectance(550.0), 0.25);
    EXPECT_EQ(own.name, "grey");
}

TEST_F(Composition, AnErrorInAKeyOverAPresetIsPlacedInTheScene) {
    const Caught error = refusal("[[material]]\nname = \"grey\"\npreset = \"red-lacquer\"\n"
                                 "[material.substrate]\nreflectance = 1.5");
    EXPECT_EQ(error.line, 14) << error.text;
    EXPECT_NE(error.file.find("scene.toml"), std::string::npos) << error.file;
    EXPECT_EQ(refusal("[[material]]\nname = \"grey\"\npreset = \"red-lacquer\"\ncolour = 1").line,
              13);
}

TEST_F(Composition, APresetWithTexturesAndAMixtureOfTheScene) {
    write("own.toml", "[material]\nsubstrate = { type = \"lambert\", reflectance = 0.3 }\n");
    const Scene scene =
        read("[[texture]]\nname = \"c\"\ntype = \"checker\"\n"
             "[[material]]\nname = \"grey\"\npreset = \"own.toml\"\n"
             "mix = { with = \"b\", weight = { texture = \"c\" } }\n"
             "substrate = { reflectance = { texture = \"c\", low = 0.1, high = 0.9 } }\n"
             "[[material]]\nname = \"b\"\nsubstrate = { type = \"lambert\" }");
    EXPECT_EQ(scene.surfaces.at(0).mixed_with, 1);
    EXPECT_EQ(scene.surfaces.at(0).mix_texture, 0);
    EXPECT_EQ(scene.surfaces.at(0).textures, std::vector<int>{0});
}

TEST_F(Composition, OtherFilesBringMaterialsAndTextures) {
    write("more.toml", "include = [\"deep.toml\"]\n[[material]]\nname = \"grey\"\n"
                       "substrate = { type = \"lambert\", reflectance = { texture = \"t\" } }\n");
    write("deep.toml", "[[texture]]\nname = \"t\"\ntype = \"checker\"\n");
    const auto file =
        write("scene.toml", "include = [\"more.toml\", \"deep.toml\"]\n" +
                                replaced(SMALL_SCENE,
                                         "[[material]]\nname = \"grey\"\n[material.substrate]\n"
                                         "type = \"lambert\"\nreflectance = 0.5",
                                         ""));
    const Scene scene = load_scene(file);
    EXPECT_EQ(scene.surfaces.at(0).name, "grey");
    EXPECT_EQ(scene.textures.size(), 1u);
    const std::string hash = scene.hash;
    write("deep.toml", "[[texture]]\nname = \"t\"\ntype = \"checker\"\nsize = 2\n");
    EXPECT_NE(load_scene(file).hash, hash); // what is included counts
}

TEST_F(Composition, FilesThatIncludeEachOtherAreRefusedAtTheirPlace) {
    write("a.toml", "# a\ninclude = [\"b.toml\"]\n");
    write("b.toml", "# b\n\ninclude = [\"a.toml\"]\n");
    const auto file = write("scene.toml", std::string("include = [\"a.toml\"]\n") + SMALL_SCENE);
    const Caught circle = error_of([&] { load_scene(file); });
    EXPECT_EQ(circle.exit_code, 2);
    EXPECT_NE(circle.file.find("b.toml"), std::string::npos) << circle.file;
    EXPECT_EQ(circle.line, 3) << circle.text;
    EXPECT_NE(circle.text.find("a.toml includes b.toml includes a.toml"), std::string::npos)
        << circle.text;
    const auto lost = write("scene.toml", std::string("include = [\"none.toml\"]\n") + SMALL_SCENE);
    EXPECT_EQ(error_of([&] { load_scene(lost); }).line, 1);
    write("odd.toml", "[film]\nwidth = 1\n");
    const auto odd = write("scene.toml", std::string("include = [\"odd.toml\"]\n") + SMALL_SCENE);
    EXPECT_NE(error_of([&] { load_scene(odd); }).file.find("odd.toml"), std::string::npos);
}

TEST_F(Composition, OpacityIsANumberOrATexture) {
    EXPECT_EQ(read(GREY + "opacity = 0.25\n").surfaces.at(0).opacity,
              (std::array<double, 2>{0.25, 0.25}));
    const Scene scene = read("[[texture]]\nname = \"c\"\ntype = \"checker\"\n" + GREY +
                             "opacity = { texture = \"c\", high = 0.5 }\n");
    EXPECT_EQ(scene.surfaces.at(0).opacity, (std::array<double, 2>{0.0, 0.5}));
    EXPECT_EQ(scene.surfaces.at(0).opacity_texture, 0);
    EXPECT_TRUE(scene.surfaces.at(0).textures.empty()); // no material of its own for it
    EXPECT_EQ(refusal(GREY + "opacity = 1.5\n").line, 13);
}

TEST_F(Composition, ConcentrationChangesWhatAFluorophoreAbsorbs) {
    const auto excitation = [&](const std::string& concentration) {
        const Scene scene = read(
            "[[material]]\nname = \"grey\"\nsubstrate = { type = \"lambert\", reradiation = { "
            "fluorophores = [{ excitation = { gaussian_nm = 450, sigma_nm = 20, scale = 0.6 }, "
            "emission = { gaussian_nm = 550, sigma_nm = 20 }" +
            concentration + " }] } }");
        return scene.materials.at(0).substrate.fluorophores.at(0).excitation;
    };
    EXPECT_NEAR(excitation("")(450.0), 0.6, 1e-12);
    EXPECT_NEAR(excitation(", concentration = 2")(450.0), 1.0 - 0.4 * 0.4, 1e-9);
    EXPECT_NEAR(excitation(", concentration = 1e-6")(450.0), -1e-6 * std::log(0.4), 1e-12);
    EXPECT_EQ(excitation(", concentration = 0")(450.0), 0.0);
}

TEST_F(Composition, StrengthLeavesAMatrixItsReflectance) {
    const auto matrix = [&](const std::string& strength) {
        const Scene scene =
            read("[[texture]]\nname = \"c\"\ntype = \"checker\"\n[[material]]\nname = \"grey\"\n"
                 "substrate = { type = \"lambert\", reradiation = { file = "
                 "\"synthetic-orange.csv\"" +
                 strength + " } }");
        return *scene.materials.back().substrate.matrix;
    };
    const ReradiationMatrix whole = matrix(""), half = matrix(", strength = 0.5");
    const Eigen::MatrixXd off = whole.fluorescent_part();
    EXPECT_LT((half.fluorescent_part() - 0.5 * off).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT(
        ((half.values - half.fluorescent_part()) - (whole.values - off)).cwiseAbs().maxCoeff(),
        1e-12);
    // the last variant of the textured one is the strongest
    const ReradiationMatrix textured = matrix(", strength = { texture = \"c\" }");
    EXPECT_LT((textured.values - whole.values).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(Composition, MeshesAreScaledTurnedAndMovedInThisOrder) {
    write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto scene_of = [&](const std::string& keys) {
        return load_scene(write("scene.toml", std::string(SMALL_SCENE) +
                                                  "[[shape]]\nfile = \"one.obj\"\n" +
                                                  "material = \"grey\"\n" + keys));
    };
    const std::string moved = "scale = 2\nrotate_deg = [0, 0, 90]\ntranslate = [5, 0, 0]\n";
    const Scene scene = scene_of("type = \"mesh\"\n" + moved);
    const auto& mesh = std::get<MeshShape>(scene.shapes.at(1).geometry);
    EXPECT_NEAR(mesh.positions.at(3), 5.0, 1e-6);
    EXPECT_NEAR(mesh.positions.at(4), 2.0, 1e-6);
    const Scene instances = scene_of("type = \"instance\"\n" + moved +
                                     "[[shape]]\nfile = \"one.obj\"\nmaterial = \"grey\"\n"
                                     "type = \"instance\"\n");
    const auto& one = std::get<MeshInstance>(instances.shapes.at(1).geometry);
    const auto& other = std::get<MeshInstance>(instances.shapes.at(2).geometry);
    EXPECT_EQ(one.mesh, other.mesh); // one in memory
    EXPECT_NEAR(one.transform[3], 5.0, 1e-12);
    EXPECT_NEAR(one.transform[4], 2.0, 1e-12);
    EXPECT_EQ(other.transform[0], 1.0);
    const auto line_of = [&](const std::string& keys) {
        return error_of([&] { scene_of("type = \"instance\"\n" + keys); }).line;
    };
    EXPECT_EQ(line_of("scale = [1, 0, 1]\n"), 24);
    EXPECT_EQ(line_of("translate = [1, 0, 1]\ntransform = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n"),
              24);
    EXPECT_EQ(line_of("rotate = [1, 0, 1]\n"), 24);
}

TEST_F(Composition, CylindersHaveTwoEnds) {
    const auto scene_of = [&](const std::string& to) {
        return load_scene(write("scene.toml", std::string(SMALL_SCENE) +
                                                  "[[shape]]\ntype = \"cylinder\"\n" +
                                                  "from = [0, 0, 0]\nto = " + to +
                                                  "\nradius = 0.5\nmaterial = \"grey\"\n"));
    };
    EXPECT_EQ(std::get<CylinderShape>(scene_of("[0, 2, 0]").shapes.at(1).geometry).to[1], 2.0);
    EXPECT_EQ(error_of([&] { scene_of("[0, 0, 0]"); }).line, 23);
}
