#include "reradiant/scene_file.h"
#include "tests/scene/scratch.h"

#include <cmath>

using namespace reradiant;
using namespace reradiant::testing;

using SceneFile = Scratch;

namespace {

const char* const FULL_SCENE = R"([film]
width = 512
height = 256
bands_nm = { from = 300, to = 780, step = 10 }
[camera]
origin = [0, 2.2, 6.0]
target = [0, 1, 0]
up = [0, 0, -1]
fov_deg = 40
lens_radius = 0.1
focus_distance = 6.5
[integrator]
max_depth = 12
min_depth = 5
[[light]]
type = "rectangle"
center = [2, 5, 3]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
radiance = 12
[[light]]
type = "sphere"
center = [0, 9, 0]
radius = 0.5
radiance = { line_nm = 405, width_nm = 2, scale = 3 }
[[light]]
type = "point"
position = [1, 2, 3]
intensity = 4
[[light]]
type = "directional"
direction = [0, -1, 0]
irradiance = 5
[[light]]
type = "environment"
radiance = 0.5
[[shape]]
type = "sphere"
center = [0, 1, 0]
radius = 1
material = "coat"
[[shape]]
type = "rectangle"
center = [0, 0, 0]
edge_u = [4, 0, 0]
edge_v = [0, 0, -4]
material = "base"
[[shape]]
type = "disk"
center = [0, 3, 0]
normal = [0, 2, 0]
radius = 2
material = "base"
[[shape]]
type = "mesh"
file = "triangle.obj"
material = "base"
[[material]]
name = "base"
substrate = { type = "lambert", reflectance = 0.25 }
[[material]]
name = "coat"
model = "weidlich-wilkie"
  [[material.layer]]
  ior = 1.5
  roughness_deg = 10
  distribution = "beckmann"
  scattering = "single"
  thickness = 0.5
  absorption = 2
  [[material.layer]]
  ior = { nm = [400, 700], value = [1.6, 1.5] }
  alpha = 0.26
  [material.substrate]
  type = "lambert"
  reflectance = 0.75
)";

const char* const TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

} // namespace

TEST_F(SceneFile, FilmCameraAndIntegratorAreRead) {
    write("triangle.obj", TRIANGLE);
    const Scene scene = load_scene(write("scene.toml", FULL_SCENE));
    EXPECT_EQ(scene.film.width, 512);
    EXPECT_EQ(scene.film.height, 256);
    ASSERT_TRUE(scene.film.bands.has_value());
    EXPECT_EQ(scene.film.bands->count, 49);
    EXPECT_EQ(scene.camera.origin, (Vector3{0, 2.2, 6}));
    EXPECT_EQ(scene.camera.target, (Vector3{0, 1, 0}));
    EXPECT_EQ(scene.camera.up, (Vector3{0, 0, -1}));
    EXPECT_EQ(scene.camera.fov_deg, 40.0);
    EXPECT_EQ(scene.camera.lens_radius, 0.1);
    EXPECT_EQ(scene.camera.focus_distance, 6.5);
    EXPECT_EQ(scene.integrator.max_depth, 12);
    EXPECT_EQ(scene.integrator.min_depth, 5);
}

TEST_F(SceneFile, EveryKindOfLightIsRead) {
    write("triangle.obj", TRIANGLE);
    const Scene scene = load_scene(write("scene.toml", FULL_SCENE));
    ASSERT_EQ(scene.lights.size(), 5u);
    const auto& rectangle = std::get<RectangleLight>(scene.lights[0]);
    EXPECT_EQ(rectangle.edge_v, (Vector3{0, 0, 1}));
    EXPECT_EQ(light_spectrum(scene.lights[0])(500.0), 12.0);
    EXPECT_EQ(std::get<SphereLight>(scene.lights[1]).radius, 0.5);
    EXPECT_EQ(light_spectrum(scene.lights[1])(405.0), 1.5);
    EXPECT_EQ(std::get<PointLight>(scene.lights[2]).position, (Vector3{1, 2, 3}));
    EXPECT_EQ(light_spectrum(scene.lights[2])(500.0), 4.0);
    EXPECT_EQ(std::get<DirectionalLight>(scene.lights[3]).direction, (Vector3{0, -1, 0}));
    EXPECT_EQ(light_spectrum(scene.lights[3])(500.0), 5.0);
    EXPECT_EQ(light_spectrum(scene.lights[4])(500.0), 0.5);
}

TEST_F(SceneFile, EveryKindOfShapeIsRead) {
    write("triangle.obj", TRIANGLE);
    const Scene scene = load_scene(write("scene.toml", FULL_SCENE));
    ASSERT_EQ(scene.shapes.size(), 4u);
    EXPECT_EQ(std::get<SphereShape>(scene.shapes[0].geometry).radius, 1.0);
    EXPECT_EQ(scene.shapes[0].material, 1);
    EXPECT_EQ(std::get<RectangleShape>(scene.shapes[1].geometry).edge_v, (Vector3{0, 0, -4}));
    EXPECT_EQ(scene.shapes[1].material, 0);
    EXPECT_EQ(std::get<DiskShape>(scene.shapes[2].geometry).normal, (Vector3{0, 2, 0}));
    EXPECT_EQ(std::get<MeshShape>(scene.shapes[3].geometry).indices.size(), 3u);
}

TEST_F(SceneFile, LayersAreReadFromTheAirDown) {
    write("triangle.obj", TRIANGLE);
    const Scene scene = load_scene(write("scene.toml", FULL_SCENE));
    const Material& coat = scene.materials[1];
    EXPECT_EQ(coat.model, Model::WeidlichWilkie);
    ASSERT_EQ(coat.stack.layers.size(), 2u);
    const Layer& top = coat.stack.layers[0];
    EXPECT_EQ(top.distribution, Distribution::Beckmann);
    EXPECT_EQ(top.scattering, Scattering::Single);
    EXPECT_EQ(top.thickness, 0.5);
    EXPECT_EQ(top.absorption(500.0), 2.0);
    // Half angle: beckmann alpha = tan b / sqrt(ln 2 - 4 ln cos b); both sides in double.
    const double b = 10.0 * std::acos(-1.0) / 180.0;
    EXPECT_NEAR(top.alpha, std::tan(b) / std::sqrt(std::log(2.0) - 4.0 * std::log(std::cos(b))),
                1e-14);
    EXPECT_EQ(coat.stack.layers[1].alpha, 0.26);
    EXPECT_EQ(coat.stack.layers[1].distribution, Distribution::Ggx);
    EXPECT_NEAR(coat.stack.layers[1].ior(550.0), 1.55, 1e-12); // linear between nodes
    EXPECT_EQ(scene.materials[0].substrate.reflectance(500.0), 0.25);
}

TEST_F(SceneFile, WhatIsLeftOutHasTheDocumentedDefault) {
    const Scene scene = load_scene(write("scene.toml", SMALL_SCENE));
    EXPECT_FALSE(scene.film.bands.has_value());
    EXPECT_EQ(scene.camera.up, (Vector3{0, 1, 0}));
    EXPECT_EQ(scene.camera.fov_deg, 35.0);
    EXPECT_EQ(scene.camera.lens_radius, 0.0);
    EXPECT_EQ(scene.integrator.max_depth, 8);
    EXPECT_EQ(scene.materials[0].model, Model::Auto);
    EXPECT_TRUE(scene.materials[0].stack.layers.empty());
}

TEST_F(SceneFile, TheHashFollowsTheSceneAndEveryFileThatItNames) {
    const auto mesh = write("triangle.obj", TRIANGLE);
    const auto file = write("scene.toml", FULL_SCENE);
    const std::string first = load_scene(file).hash;
    EXPECT_EQ(first.size(), 64u);
    EXPECT_EQ(load_scene(file).hash, first);
    write("triangle.obj", std::string(TRIANGLE) + "# changed\n");
    EXPECT_NE(load_scene(file).hash, first);
    write("triangle.obj", TRIANGLE);
    EXPECT_EQ(load_scene(file).hash, first);
    write("scene.toml", std::string(FULL_SCENE) + "# changed\n");
    EXPECT_NE(load_scene(file).hash, first);
}

TEST_F(SceneFile, APresetIsLookedUpAmongTheMaterials) {
    const std::string text =
        replaced(SMALL_SCENE, "[material.substrate]\ntype = \"lambert\"\nreflectance = 0.5",
                 "preset = \"fluorescent-orange-smooth\"");
    const Scene scene = load_scene(write("scene.toml", text));
    EXPECT_EQ(scene.materials[0].name, "grey");
    EXPECT_EQ(scene.materials[0].stack.layers.size(), 1u);
    EXPECT_TRUE(scene.materials[0].substrate.is_fluorescent());
}
