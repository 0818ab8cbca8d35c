#include "tests/geometry/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
constexpr float INFINITE = std::numeric_limits<float>::infinity();

std::string error_for(Shape shape) {
    Scene scene;
    scene.file = "scene.toml";
    scene.shapes = {shape_of(SphereShape{{0, 0, 0}, 1.0}), std::move(shape)};
    try {
        const Geometry geometry(scene);
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2);
        return error.what();
    }
    return "no error";
}

MeshShape triangle() {
    MeshShape mesh;
    mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    mesh.indices = {0, 1, 2};
    return mesh;
}

void expect_holds(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

} // namespace

TEST(BadGeometry, Case06RaysThatAreNotFiniteOrHaveNoDirectionHitNothing) {
    Scene scene;
    scene.shapes = {shape_of(SphereShape{{0, 0, 0}, 1.0}), shape_of(triangle())};
    const Geometry geometry(scene);
    std::vector<RayRecord> rays(9, ray_record({0, 0, 5}, {0, 0, -1}));
    rays[0].direction_x = NOT_A_NUMBER;
    rays[1].direction_z = INFINITE;
    rays[2].direction_z = 0.0f;
    rays[3].origin_y = NOT_A_NUMBER;
    rays[4].origin_y = -INFINITE;
    rays[5].t_far = NOT_A_NUMBER;
    rays[6].t_near = NOT_A_NUMBER;
    rays[7].direction_x = INFINITE;
    rays[7].direction_y = -INFINITE;
    const auto hits = trace(geometry, rays);
    geometry.occlude(rays, 0);
    for (std::size_t i = 0; i + 1 < rays.size(); ++i) {
        EXPECT_EQ(hits[i].shape, NO_INDEX) << i;
        EXPECT_EQ(rays[i].t_far, -1.0f) << i;
    }
    EXPECT_EQ(hits.back().shape, 0u);
}

TEST(BadGeometry, Case07MeshesThatEmbreeWouldDropAreRefusedByName) {
    MeshShape mesh = triangle();
    mesh.positions[4] = NOT_A_NUMBER;
    expect_holds(error_for(shape_of(mesh)), "scene.toml: shape 1: y of vertex 1 is nan");
    mesh.positions[4] = 2e18f;
    expect_holds(error_for(shape_of(mesh)), "shape 1: y of vertex 1 is 2e+18");
    mesh = triangle();
    mesh.indices[2] = 7;
    expect_holds(error_for(shape_of(mesh)), "shape 1: triangle 0 refers to vertex 7 of 3");
    mesh = triangle();
    mesh.normals = {0, 0, 1};
    expect_holds(error_for(shape_of(mesh)), "not one a vertex");
    mesh.indices.clear();
    expect_holds(error_for(shape_of(mesh)), "not whole");
}

TEST(BadGeometry, DegenerateShapesAreRefusedByName) {
    expect_holds(error_for(shape_of(SphereShape{{0, 0, 0}, 0.0})), "shape 1: the radius is 0");
    expect_holds(error_for(shape_of(SphereShape{{0, std::nan(""), 0}, 1.0})), "y of center is nan");
    expect_holds(error_for(shape_of(DiskShape{{0, 0, 0}, {0, 0, 0}, 1.0})), "normal is zero");
    expect_holds(error_for(shape_of(RectangleShape{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}})), "no area");
    expect_holds(error_for(shape_of(RectangleShape{{0, 0, 0}, {0, 0, 0}, {2, 0, 0}})), "no area");
    expect_holds(error_for(shape_of(RectangleShape{{0, 3e18, 0}, {1, 0, 0}, {0, 1, 0}})),
                 "y of center is 3e+18");
}
