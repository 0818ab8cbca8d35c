#include "tests/scene/scratch.h"

#include "host/film/display/png.h"
#include "reradiant/scene_file.h"

#include <cmath>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

/// SMALL_SCENE whose material (its keys stand from line 11 on) and textures are a test's own.
class Textures : public Scratch {
protected:
    std::filesystem::path scene(const std::string& material, const std::string& textures) const {
        return write("scene.toml",
                     replaced(SMALL_SCENE,
                              "[material.substrate]\ntype = \"lambert\"\nreflectance = 0.5\n",
                              material + "\n") +
                         textures);
    }
    void expect_error(const std::string& material, const std::string& textures, int line,
                      int column, const std::string& message) const {
        const auto file = scene(material, textures);
        const Caught error = error_of([&] { load_scene(file); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_EQ(error.line, line) << error.text;
        EXPECT_EQ(error.column, column) << error.text;
        EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
    }
    /// 2 x 1 pixels: black and rgb (255, 255, 0).
    void write_image(const std::string& name) const {
        write_png(folder / name, 2, 1, {0, 0, 0, 255, 255, 0}, true);
    }
};

const std::string CHECKER = "[[texture]]\nname = \"squares\"\ntype = \"checker\"\n";
const std::string NOISE = "[[texture]]\nname = \"clouds\"\ntype = \"noise\"\nlevels = 3\n";

std::string lambert(const std::string& reflectance) {
    return "substrate = { type = \"lambert\", reflectance = " + reflectance + " }";
}

} // namespace

TEST_F(Textures, ATexturedMaterialHasAVariantForEveryLevel) {
    const Scene read = load_scene(scene(
        lambert("{ texture = \"clouds\", low = 0.2, high = { rgb = [0.6, 0.6, 0.6] } }"), NOISE));
    ASSERT_EQ(read.surfaces.size(), 1u);
    const Surface& surface = read.surfaces[0];
    EXPECT_EQ(surface.textures, std::vector<int>{0});
    ASSERT_EQ(read.materials.size(), 1u + 3u); // the middle, then the levels
    for (int level = 0; level < 3; ++level)
        EXPECT_NEAR(read.materials[static_cast<std::size_t>(surface.first_material + level)]
                        .substrate.reflectance(550.0),
                    0.2 + 0.2 * level, 1e-12);
}

TEST_F(Textures, TheLastTextureRunsFastest) {
    const Scene read = load_scene(
        scene("layer = [ { ior = 1.5, thickness = { texture = \"squares\", low = 1, high = 2 }, "
              "alpha = { texture = \"clouds\", low = 0, high = 0.4 } } ]\n" +
                  lambert("0.5"),
              CHECKER + NOISE));
    const Surface& surface = read.surfaces.at(0);
    ASSERT_EQ(surface.textures.size(), 2u);
    // Keys are read in the order of the reader: alpha before thickness.
    EXPECT_EQ(read.textures.at(static_cast<std::size_t>(surface.textures[0])).name, "clouds");
    const auto layer = [&](int i) {
        return read.materials
            .at(static_cast<std::size_t>(surface.first_material) + static_cast<std::size_t>(i))
            .stack.layers.at(0);
    };
    EXPECT_EQ(layer(0).thickness, 1.0);
    EXPECT_EQ(layer(1).thickness, 2.0);
    EXPECT_EQ(layer(1).alpha, 0.0);
    EXPECT_NEAR(layer(2).alpha, 0.2, 1e-15);
    EXPECT_EQ(layer(5).alpha, 0.4);
}

TEST_F(Textures, LowAndHighMayStandAtTheTexture) {
    const Scene read = load_scene(scene(lambert("{ texture = \"squares\", high = 0.9 }"),
                                        CHECKER + "low = 0.3\nhigh = 0.4\n"));
    const auto first = static_cast<std::size_t>(read.surfaces[0].first_material);
    EXPECT_EQ(read.materials[first].substrate.reflectance(550.0), 0.3);
    EXPECT_EQ(read.materials[first + 1].substrate.reflectance(550.0), 0.9);
}

TEST_F(Textures, ConcentrationsOfFluorophoresAndDyesFollowTextures) {
    const std::string glow =
        "{ type = \"lambert\", reradiation = { fluorophores = [ { emission = { gaussian_nm = 600, "
        "sigma_nm = 20 }, excitation = { texture = \"squares\", high = 0.8 }, quantum_yield = { "
        "texture = \"squares\", low = 0.5 } } ] } }";
    const Scene read = load_scene(scene("substrate = " + glow, CHECKER));
    const auto first = static_cast<std::size_t>(read.surfaces[0].first_material);
    EXPECT_FALSE(read.materials[first].substrate.is_fluorescent());
    EXPECT_TRUE(read.materials[first + 1].substrate.is_fluorescent());
    EXPECT_EQ(read.materials[first].substrate.fluorophores[0].quantum_yield, 0.5);
}

TEST_F(Textures, KeysOfTheTypesAreRead) {
    const Scene read = load_scene(
        scene(lambert("{ texture = \"a\", high = 0.5 }"),
              "[[texture]]\nname = \"a\"\ntype = \"voronoi\"\nsize = 0.05\nshare = 0.25\n"
              "tilt_deg = 10\nseed = 7\nspace = \"uv\"\n"
              "[[texture]]\nname = \"b\"\ntype = \"noise\"\noctaves = 2\nsharpness = 3\n"));
    const Texture& voronoi = read.textures[0];
    EXPECT_EQ(voronoi.type, TextureType::Voronoi);
    EXPECT_EQ(voronoi.size, 0.05);
    EXPECT_EQ(voronoi.share, 0.25);
    EXPECT_EQ(voronoi.levels, 2); // two values only
    EXPECT_EQ(voronoi.tilt_deg, 10.0);
    EXPECT_EQ(voronoi.seed, 7u);
    EXPECT_EQ(voronoi.space, TextureSpace::Uv);
    EXPECT_EQ(read.textures[1].octaves, 2);
    EXPECT_EQ(read.textures[1].sharpness, 3.0);
    EXPECT_EQ(read.textures[1].space, TextureSpace::World);
}

TEST_F(Textures, AnImageAsAReflectanceKeepsItsColours) {
    write_image("two.png");
    const std::string image = "[[texture]]\nname = \"two\"\ntype = \"image\"\nfile = \"two.png\"\n";
    const Scene read = load_scene(scene(lambert("{ texture = \"two\", high = 0.5 }"), image));
    ASSERT_EQ(read.images.size(), 1u);
    EXPECT_EQ(read.images[0].rgb, (std::vector<float>{0, 0, 0, 1, 1, 0}));
    EXPECT_EQ(read.materials.size(), 1u);
    EXPECT_EQ(read.materials[0].substrate.reflectance_image, 0);
    EXPECT_EQ(read.materials[0].substrate.reflectance(550.0), 0.5);
    // With a low end it is a texture like any other.
    const Scene grey =
        load_scene(scene(lambert("{ texture = \"two\", low = 0.1, high = 0.5 }"), image));
    EXPECT_EQ(grey.materials[0].substrate.reflectance_image, -1);
    EXPECT_EQ(grey.materials.size(), 1u + 8u);
}

TEST_F(Textures, AnEnvironmentImageStandsAlone) {
    write_image("sky.png");
    const std::string sky = "[[light]]\ntype = \"environment\"\nfile = \"sky.png\"\n";
    expect_error(lambert("0.5"), sky, 18, 1, "an environment image stands beside another");
}

TEST_F(Textures, ReferencesThatMeanNothingAreRefused) {
    expect_error(lambert("{ texture = \"cloud\" }"), NOISE, 12, 49,
                 "no texture is called \"cloud\"; there are: clouds");
    expect_error(lambert("{ texture = \"clouds\", lo = 0.1 }"), NOISE, 12, 69,
                 "did you mean \"low\"?");
    expect_error(lambert("{ texture = \"clouds\", high = { texture = \"clouds\" } }"), NOISE, 12,
                 78, "cannot be textures");
    expect_error(lambert("0.5"), NOISE + CHECKER + NOISE, 26, 1, "two textures are called");
    const auto light =
        write("scene.toml",
              replaced(SMALL_SCENE, "radiance = 1", "radiance = { texture = \"clouds\" }") + NOISE);
    EXPECT_NE(error_of([&] { load_scene(light); }).text.find("only materials have textures"),
              std::string::npos);
}

TEST_F(Textures, EndsOutOfRangeAreRefused) {
    expect_error(lambert("{ texture = \"clouds\", high = 1.2 }"), NOISE, 12, 33, "at most 1");
    expect_error("layer = [ { ior = 1.5, alpha = { texture = \"clouds\", high = 2 } } ]\n" +
                     lambert("0.5"),
                 NOISE, 12, 24, "alpha reaches 2");
    expect_error("layer = [ { ior = { texture = \"clouds\", high = 2 } } ]\n" + lambert("0.5"),
                 NOISE, 12, 13, "above 0"); // its low end is 0
}

TEST_F(Textures, KeysOutOfRangeOrOfAnotherTypeAreRefused) {
    const auto refused = [&](const std::string& type, const std::string& key,
                             const std::string& message) {
        expect_error(lambert("0.5"),
                     "[[texture]]\nname = \"t\"\ntype = \"" + type + "\"\n" + key + "\n", 21, 1,
                     message);
    };
    refused("noise", "size = 0", "at least 1e-09");
    refused("noise", "levels = 1", "from 2 to 512");
    refused("noise", "octaves = 0", "from 1 to 16");
    refused("voronoi", "tilt_deg = 61", "at most 60");
    refused("voronoi", "share = 0", "above 0");
    refused("voronoi", "share = 1", "below 1");
    refused("voronoi", "octaves = 2", "unknown key");
    refused("checker", "seed = 2", "unknown key");
    refused("noise", "share = 0.5", "unknown key");
    refused("image", "file = \"none.png\"", "cannot open \"none.png\"");
    refused("image", "file = \"scene.toml\"", "is no image");
    refused("noise", "space = \"mars\"", "uv");
}

TEST_F(Textures, DamagedImagesAreRefused) {
    write_image("two.png");
    const auto size = std::filesystem::file_size(folder / "two.png");
    std::filesystem::resize_file(folder / "two.png", size - 20);
    const auto file = scene(lambert("0.5"), "[[texture]]\nname = \"two\"\ntype = \"image\"\n"
                                            "file = \"two.png\"\n");
    const Caught error = error_of([&] { load_scene(file); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_NE(error.file.find("two.png"), std::string::npos) << error.text;
}

TEST_F(Textures, NormalsNeedATextureThatHasThem) {
    write_image("two.png");
    expect_error("normal = { texture = \"clouds\" }\n" + lambert("0.5"), NOISE, 12, 1,
                 "has no normals");
    expect_error("normal = { texture = \"none\" }\n" + lambert("0.5"), NOISE, 12, 12,
                 "no texture is called");
    const std::string map =
        "[[texture]]\nname = \"bumps\"\ntype = \"image\"\nfile = \"two.png\"\nnormal_map = true\n";
    expect_error(lambert("{ texture = \"bumps\" }"), map, 12, 49, "is a normal map");
    expect_error("mix = { with = \"sugar\", weight = { texture = \"bumps\" } }\n" + lambert("0.5"),
                 map, 12, 25, "is a normal map");
    const Scene read =
        load_scene(scene("normal = { texture = \"bumps\" }\n" + lambert("0.5"), map));
    EXPECT_EQ(read.surfaces[0].normal_texture, 0);
    EXPECT_TRUE(read.textures[0].is_normal_map);
}

TEST_F(Textures, MixturesNameAnotherMaterialOrAPreset) {
    const Scene read = load_scene(
        scene("mix = { with = \"sugar\", weight = { texture = \"squares\" } }\n" + lambert("0.5"),
              CHECKER));
    ASSERT_EQ(read.surfaces.size(), 2u); // the preset comes with it
    EXPECT_EQ(read.surfaces[0].mixed_with, 1);
    EXPECT_EQ(read.surfaces[0].mix_texture, 0);
    EXPECT_EQ(read.surfaces[1].name, "sugar");
    const auto mixed = [&](const std::string& keys) {
        return "mix = { " + keys + " }\n" + lambert("0.5");
    };
    expect_error(mixed("with = \"none\", weight = 0.5"), "", 12, 9, "no material is called");
    expect_error(mixed("with = \"grey\", weight = 0.5"), "", 12, 9, "mixed with itself");
    expect_error(mixed("with = \"sugar\", weight = 1.5"), "", 12, 25, "at most 1");
    // sunstone is a mixture itself, and brings what it is mixed with
    const Scene nested = load_scene(scene(mixed("with = \"sunstone\", weight = 0.5"), ""));
    ASSERT_EQ(nested.surfaces.size(), 3u);
    EXPECT_EQ(nested.surfaces[1].mixed_with, 2);
    expect_error(mixed("with = \"sugar\""), "", 12, 7, "has no \"weight\"");
}

TEST_F(Textures, TooManyCombinationsAreRefused) {
    std::string layer = "ior = 1.5", textures;
    const std::vector<std::string> keys{"alpha", "thickness", "absorption", "anisotropy"};
    for (std::size_t i = 0; i < keys.size(); ++i) {
        layer += ", " + keys[i] + " = { texture = \"t" + std::to_string(i) + "\", high = 0.5 }";
        textures +=
            "[[texture]]\nname = \"t" + std::to_string(i) + "\"\ntype = \"noise\"\nlevels = 9\n";
        if (i == 2)
            expect_error("layer = [ { " + layer + " } ]\n" + lambert("0.5"), textures, 10, 1,
                         "729 combinations");
    }
    expect_error("layer = [ { " + layer + " } ]\n" + lambert("0.5"), textures, 10, 1,
                 "follow 4 textures");
}

TEST_F(Textures, AMaterialFileStandsAtTheMiddleOfItsTextures) {
    const Material material = load_material(
        write("m.toml", NOISE + "[material]\n" +
                            lambert("{ texture = \"clouds\", low = 0.2, high = 0.6 }") + "\n"));
    EXPECT_NEAR(material.substrate.reflectance(550.0), 0.4, 1e-15);
}
