#include "host/scene/meshes/placement.h"
#include "tests/geometry/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

/// Turned, stretched and moved.
constexpr std::array<double, 12> ROWS{1.2, -0.5, 0, 2, 0.6, 1.0, 0.1, -1, 0, 0.2, -0.7, 0.5};

MeshShape moved(const MeshShape& mesh, const std::array<double, 12>& rows) {
    const Placement placement(rows);
    MeshShape result = mesh;
    for (std::size_t k = 0; k < mesh.positions.size(); k += 3) {
        const kernels::Vec3 p = placement.point(
            kernels::vec3(mesh.positions[k], mesh.positions[k + 1], mesh.positions[k + 2]));
        result.positions[k] = static_cast<float>(p.x);
        result.positions[k + 1] = static_cast<float>(p.y);
        result.positions[k + 2] = static_cast<float>(p.z);
    }
    return result;
}

Scene scene_of(const std::vector<Shape>& shapes) {
    Scene scene;
    scene.shapes = shapes;
    return scene;
}

} // namespace

TEST(Instances, AreMetWhereTheMovedMeshIs) {
    const auto mesh = std::make_shared<const MeshShape>(triangle_sphere({0.1, 0, 0}, 1.0, 3));
    auto rows = ROWS;
    rows[3] -= 8.0;
    const Scene instances =
        scene_of({shape_of(MeshInstance{mesh, ROWS}), shape_of(MeshInstance{mesh, rows})});
    const Scene copies = scene_of({shape_of(moved(*mesh, ROWS)), shape_of(moved(*mesh, rows))});
    const Geometry one(instances), other(copies);
    EXPECT_EQ(one.triangle_count(), other.triangle_count());
    const auto rays = random_rays(200000, 7);
    const auto found = trace(one, rays), expected = trace(other, rays);
    std::size_t met = 0, apart = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        apart += found[i].shape != expected[i].shape;
        if (found[i].shape == NO_INDEX || found[i].shape != expected[i].shape)
            continue;
        ++met;
        // Corners are rounded to single precision in the one, the matrix in the other.
        ASSERT_NEAR(found[i].distance, expected[i].distance, 2e-5 * (1.0 + found[i].distance));
        ASSERT_NEAR(found[i].normal_x, expected[i].normal_x, 1e-4);
    }
    EXPECT_GT(met, 1000u);
    EXPECT_LE(apart, met / 1000); // rays that touch an edge
}

TEST(Instances, KeepNormalsOnTheSideOfTheirTriangles) {
    auto mesh = std::make_shared<MeshShape>(triangle_sphere({}, 1.0, 2));
    mesh->normals = mesh->positions; // of a unit sphere
    for (const double mirror : {1.0, -1.0}) {
        const Scene scene =
            scene_of({shape_of(MeshInstance{mesh, {2 * mirror, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}})});
        const Geometry geometry(scene);
        const HitRecord hit = trace(geometry, {ray_record({0.9, 0.3, 5}, {0, 0, -1})})[0];
        ASSERT_EQ(hit.shape, 0u);
        // On the ellipsoid x^2/4 + y^2 + z^2 = 1 the normal is along (x/4, y, z).
        const double x = 0.9 / 4, y = 0.3, z = hit.position_z, size = std::hypot(x, y, z);
        const double side = mirror; // a mirrored mesh is turned inside out
        EXPECT_NEAR(hit.shading_x, side * x / size, 0.02);
        EXPECT_NEAR(hit.shading_z, side * z / size, 0.02);
    }
}

TEST(Instances, OfNothingOrFlatAreRefused) {
    EXPECT_THROW(Geometry(scene_of({shape_of(MeshInstance{nullptr, ROWS})})), Error);
    const auto mesh = std::make_shared<const MeshShape>(triangle_sphere({}, 1.0, 1));
    auto flat = ROWS;
    std::fill_n(flat.begin(), 4, 0.0);
    EXPECT_THROW(Geometry(scene_of({shape_of(MeshInstance{mesh, flat})})), Error);
}

TEST(Cylinders, AreMetOnTheirTubeFromBothSides) {
    const CylinderShape tube{{1, -2, 0.5}, {3, 1, -1}, 0.8};
    const Geometry geometry(scene_of({shape_of(tube)}));
    const Vector3 along = sum(tube.to, tube.from, -1.0);
    const double length = std::sqrt(dot(along, along));
    std::size_t inside = 0, outside = 0;
    const auto rays = random_rays(400000, 3);
    for (std::size_t i = 0; const HitRecord& hit : trace(geometry, rays)) {
        const RayRecord& ray = rays[i++];
        if (hit.shape == NO_INDEX)
            continue;
        const Vector3 p = sum(position_of(hit), tube.from, -1.0);
        const double h = dot(p, along) / length;
        EXPECT_GE(h, -1e-5);
        EXPECT_LE(h, length + 1e-5);
        const Vector3 radial = sum(p, along, -h / length);
        EXPECT_NEAR(std::sqrt(dot(radial, radial)), 0.8, 1e-5);
        EXPECT_NEAR(dot(radial, normal_of(hit)), 0.8, 1e-5);
        EXPECT_NEAR(hit.v, h / length, 1e-5);
        const bool from_inside =
            dot(normal_of(hit), {ray.direction_x, ray.direction_y, ray.direction_z}) > 0.0;
        (from_inside ? inside : outside) += 1;
    }
    EXPECT_GT(outside, 500u);
    EXPECT_GT(inside, 100u); // through an open end
}

TEST(Cylinders, WithoutLengthAreRefused) {
    EXPECT_THROW(Geometry(scene_of({shape_of(CylinderShape{{1, 1, 1}, {1, 1, 1}, 1.0})})), Error);
}
