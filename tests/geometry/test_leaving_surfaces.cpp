#include "tests/geometry/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

/// Moves an origin off the surface as the shading kernel does, in single precision; `scale` 0
/// leaves it on the surface.
RayRecord leave(const HitRecord& hit, const Vector3& direction, float scale = 1.0f) {
    RayRecord ray = ray_record(position_of(hit), direction);
    const float cosine = hit.normal_x * ray.direction_x + hit.normal_y * ray.direction_y +
                         hit.normal_z * ray.direction_z;
    const float reach =
        scale * 2.0f * hit.position_error *
        (std::fabs(hit.normal_x) + std::fabs(hit.normal_y) + std::fabs(hit.normal_z));
    const float side = cosine < 0.0f ? -reach : reach;
    ray.origin_x += side * hit.normal_x;
    ray.origin_y += side * hit.normal_y;
    ray.origin_z += side * hit.normal_z;
    return ray;
}

/// Rays towards the surfaces of a scene of size about 1 around `centre`.
std::vector<RayRecord> rays_towards(const Vector3& centre, std::size_t count, unsigned seed) {
    std::mt19937_64 random(seed);
    std::vector<RayRecord> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3 from = sum(centre, random_direction(random), 4.0);
        const Vector3 to = sum(centre, random_direction(random), 0.7);
        const Vector3 way = sum(to, from, -1.0);
        rays.push_back(ray_record(from, sum({}, way, 1.0 / std::sqrt(dot(way, way)))));
    }
    return rays;
}

/// Returns how many rays that leave a convex or flat surface, on the side of its normal, hit it
/// again. They start where `count` rays towards `centre` hit the surface, moved off it as `leave`
/// says of `scale`.
std::size_t self_hits(const Shape& shape, const Vector3& centre, std::size_t count, float scale) {
    Scene scene;
    scene.shapes = {shape};
    const Geometry geometry(scene);
    std::mt19937_64 random(17);
    std::vector<RayRecord> leaving;
    for (const HitRecord& hit : trace(geometry, rays_towards(centre, count, 5))) {
        if (hit.shape == NO_INDEX)
            continue;
        Vector3 way = random_direction(random);
        if (dot(way, normal_of(hit)) < 0.0)
            way = sum({}, way, -1.0);
        leaving.push_back(leave(hit, way, scale));
    }
    EXPECT_GT(leaving.size(), count / 5);
    std::size_t again = 0;
    for (const HitRecord& hit : trace(geometry, leaving))
        again += hit.shape != NO_INDEX;
    return again;
}

MeshShape one_triangle(const Vector3& centre) {
    MeshShape mesh;
    const Vector3 corners[3] = {{-2, -1.5, 0.4}, {2, -1, -0.7}, {0.3, 2.5, 0.2}};
    for (const auto& corner : corners)
        for (std::size_t axis = 0; axis < 3; ++axis)
            mesh.positions.push_back(static_cast<float>(corner[axis] + centre[axis]));
    mesh.indices = {0, 1, 2};
    return mesh;
}

const double OFFSETS[] = {0.0, 1.0, 1e2, 1e4, 1e5};

} // namespace

// 1e6 rays in all: case 3 asks for none in a million.
TEST(LeavingSurfaces, Case03NoRayHitsTheSurfaceThatItLeaves) {
    for (const double offset : OFFSETS) {
        const Vector3 c{offset, -offset, 0.5 * offset};
        constexpr std::size_t COUNT = 120000;
        EXPECT_EQ(self_hits(shape_of(one_triangle(c)), c, COUNT, 1.0f), 0u) << offset;
        EXPECT_EQ(self_hits(shape_of(triangle_sphere(c, 1.0, 2)), c, COUNT, 1.0f), 0u) << offset;
        EXPECT_EQ(self_hits(shape_of(SphereShape{c, 1.0}), c, COUNT, 1.0f), 0u) << offset;
        EXPECT_EQ(
            self_hits(shape_of(RectangleShape{c, {2, 0.3, 0.1}, {0, 1.5, 1}}), c, COUNT, 1.0f), 0u)
            << offset;
        EXPECT_EQ(self_hits(shape_of(DiskShape{c, {1, 2, 3}, 1.2}), c, COUNT, 1.0f), 0u) << offset;
        const CylinderShape tube{sum(c, {1, 0.5, -0.2}, -1.0), sum(c, {1, 0.5, -0.2}, 1.0), 0.7};
        EXPECT_EQ(self_hits(shape_of(tube), c, COUNT, 1.0f), 0u) << offset;
        const MeshInstance turned{std::make_shared<const MeshShape>(triangle_sphere({}, 1.0, 2)),
                                  {0.8, -0.6, 0, c[0], 0.6, 0.8, 0, c[1], 0, 0, 0.9, c[2]}};
        EXPECT_EQ(self_hits(shape_of(turned), c, COUNT, 1.0f), 0u) << offset;
    }
}

// Shows that the test above can fail.
TEST(LeavingSurfaces, Case03WithoutTheOffsetManyRaysHitTheSurfaceAgain) {
    EXPECT_GT(self_hits(shape_of(one_triangle({1, -1, 0.5})), {1, -1, 0.5}, 20000, 0.0f), 400u);
}

TEST(LeavingSurfaces, RaysIntoAGroundOfHugeRadiusDoNotHitIt) {
    const Vector3 top{0, 0, 0};
    const Shape ground = shape_of(SphereShape{{0, -1e6, 0}, 1e6});
    EXPECT_EQ(self_hits(ground, top, 100000, 1.0f), 0u);
}

TEST(LeavingSurfaces, ARayIntoASphereMeetsItsFarSide) {
    Scene scene;
    scene.shapes = {shape_of(SphereShape{{3, -2, 1}, 1.0})};
    const Geometry geometry(scene);
    std::mt19937_64 random(3);
    std::vector<RayRecord> inward;
    std::vector<double> expected;
    for (const HitRecord& hit : trace(geometry, rays_towards({3, -2, 1}, 50000, 4))) {
        Vector3 way = random_direction(random);
        if (hit.shape == NO_INDEX || std::fabs(dot(way, normal_of(hit))) < 1e-3)
            continue;
        if (dot(way, normal_of(hit)) > 0.0)
            way = sum({}, way, -1.0);
        inward.push_back(leave(hit, way));
        expected.push_back(-2.0 * dot(way, normal_of(hit)));
    }
    const auto hits = trace(geometry, inward);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_EQ(hits[i].shape, 0u) << i;
        // The chord changes by the offset (at most 1e-6) over the cosine (at least 1e-3).
        EXPECT_NEAR(hits[i].distance, expected[i], 2e-6 / (0.5 * expected[i]) + 2e-6) << i;
    }
}

TEST(LeavingSurfaces, Case04SurfacesClosePairwiseAreBothHit) {
    const auto square = [](double z) {
        MeshShape mesh;
        const auto f = static_cast<float>(z);
        mesh.positions = {-1, -1, f, 1, -1, f, 1, 1, f, -1, 1, f};
        mesh.indices = {0, 1, 2, 0, 2, 3};
        return mesh;
    };
    for (const bool triangles : {true, false}) {
        Scene scene;
        for (const double z : {1.0, 1.0 - 4e-5})
            scene.shapes.push_back(triangles
                                       ? shape_of(square(z))
                                       : shape_of(RectangleShape{{0, 0, z}, {2, 0, 0}, {0, 2, 0}}));
        const Geometry geometry(scene);
        std::mt19937_64 random(8);
        std::uniform_real_distribution<double> place(-0.9, 0.9);
        std::vector<RayRecord> rays, onward;
        for (int i = 0; i < 50000; ++i)
            rays.push_back(ray_record({place(random), place(random), 3.0}, {0, 0, -1}));
        const auto first = trace(geometry, rays);
        for (const HitRecord& hit : first) {
            ASSERT_EQ(hit.shape, 0u);
            onward.push_back(leave(hit, {0, 0, -1}));
        }
        for (const HitRecord& hit : trace(geometry, onward))
            ASSERT_EQ(hit.shape, 1u);
    }
}

TEST(LeavingSurfaces, Case05AClosedMeshFarFromTheOriginDoesNotLeak) {
    const Vector3 centre{148376, 1234, -223423};
    Scene scene;
    scene.shapes = {shape_of(triangle_sphere(centre, 100.0, 4))};
    const Geometry geometry(scene);
    std::mt19937_64 random(9);
    std::vector<RayRecord> rays;
    for (int i = 0; i < 1000000; ++i)
        rays.push_back(ray_record(centre, random_direction(random)));
    std::size_t leaks = 0;
    for (const HitRecord& hit : trace(geometry, rays))
        leaks += hit.shape == NO_INDEX;
    EXPECT_LE(leaks, 20u); // case 5: 2e-5
}
