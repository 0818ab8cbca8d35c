#include "tests/scene/scratch.h"

#include "host/film/display/png.h"
#include "reradiant/scene_file.h"

#include <cmath>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

/// A field of 3 x 2 pixels over 4 x 2 units of the plane z = 1 (its keys stand on lines 15 to 20).
class Heightfield : public Scratch {
protected:
    void SetUp() override {
        Scratch::SetUp();
        // Rows from the top: flat, then a slope of 51/255 = 0.2 a pixel along x.
        const auto grey = [](int value) { return static_cast<std::uint8_t>(value); };
        std::vector<std::uint8_t> rgb;
        for (const int value : {0, 0, 0, 0, 51, 102})
            rgb.insert(rgb.end(), 3, grey(value));
        write_png(folder / "h.png", 3, 2, rgb, false);
    }
    static std::string scene(const std::string& keys) {
        return replaced(SMALL_SCENE, "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1",
                        "type = \"heightfield\"\n" + keys);
    }
    void expect_error(const std::string& keys, int line, const std::string& message) const {
        const auto file = write("scene.toml", scene(keys));
        const Caught error = error_of([&] { load_scene(file); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_EQ(error.line, line) << error.text;
        EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
    }
};

const std::string KEYS = "file = \"h.png\"\ncenter = [0, 0, 1]\nedge_u = [4, 0, 0]\n"
                         "edge_v = [0, 2, 0]\nheight = 5";

} // namespace

TEST_F(Heightfield, PixelsAreVerticesAboveTheirPlaces) {
    const Scene read = load_scene(write("scene.toml", scene(KEYS)));
    const auto& mesh = std::get<MeshShape>(read.shapes.at(0).geometry);
    const std::vector<float> expected{-2, 1, 1, 0, 1, 1, 2, 1, 1, -2, -1, 1, 0, -1, 2, 2, -1, 3};
    ASSERT_EQ(mesh.positions.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(mesh.positions[i], expected[i], 1e-6); // single precision
    EXPECT_EQ(mesh.texture_coordinates,
              (std::vector<float>{0, 1, 0.5f, 1, 1, 1, 0, 0, 0.5f, 0, 1, 0}));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 3, 4, 0, 4, 1, 1, 4, 5, 1, 5, 2}));
    // The bottom row rises by 1 in 2 along x; its middle falls by 1 in 2 along y.
    const double length = std::sqrt(1.0 + 0.25 + 0.25);
    EXPECT_NEAR(mesh.normals[12], -0.5 / length, 1e-6);
    EXPECT_NEAR(mesh.normals[13], 0.5 / length, 1e-6);
    EXPECT_NEAR(mesh.normals[14], 1.0 / length, 1e-6);
}

TEST_F(Heightfield, WrongKeysAreRefusedAtTheirPlace) {
    expect_error(replaced(KEYS, "h.png", "none.png"), 17, "cannot open \"none.png\"");
    expect_error(replaced(KEYS, "h.png", "scene.toml"), 17, "is no image");
    expect_error(replaced(KEYS, "edge_v = [0, 2, 0]", "edge_v = [2, 0, 0]"), 20, "no area");
    expect_error(replaced(KEYS, "height = 5", "heigth = 5"), 21, "did you mean \"height\"?");
    expect_error(replaced(KEYS, "height = 5", "height = 2e18"), 21, "at most 1e+18");
    expect_error(replaced(KEYS, "center = [0, 0, 1]\n", ""), 15, "has no \"center\"");
    write_png(folder / "line.png", 3, 1, std::vector<std::uint8_t>(9, 0), false);
    expect_error(replaced(KEYS, "h.png", "line.png"), 17, "3 x 1 pixels");
}
