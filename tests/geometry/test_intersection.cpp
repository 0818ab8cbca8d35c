#include "tests/geometry/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

using Real = long double;
struct V {
    Real x, y, z;
};
V v(const Vector3& a) {
    return {a[0], a[1], a[2]};
}
V operator-(V a, V b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
V operator+(V a, V b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
V operator*(Real s, V a) {
    return {s * a.x, s * a.y, s * a.z};
}
Real operator*(V a, V b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
V cross(V a, V b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Nearest hits by trying everything in extended precision: slow and obvious.
struct Reference {
    Real t = INFINITY;
    std::uint32_t shape = NO_INDEX, light = NO_INDEX;
    V normal{};

    void take(Real candidate, V n, std::uint32_t s, std::uint32_t l) {
        if (!(candidate > 0 && candidate < t))
            return;
        t = candidate;
        shape = s;
        light = l;
        normal = (1 / std::sqrt(n * n)) * n;
    }
    void sphere(V o, V d, V centre, Real r, std::uint32_t s, std::uint32_t l) {
        const Real a = d * d, b = (o - centre) * d, c = (o - centre) * (o - centre) - r * r;
        const Real root = std::sqrt(b * b - a * c); // NaN: no hit, and take() ignores it
        for (const Real candidate : {(-b - root) / a, (-b + root) / a})
            take(candidate, o + candidate * d - centre, s, l);
    }
    void parallelogram(V o, V d, V corner, V e1, V e2, bool half, std::uint32_t s,
                       std::uint32_t l) {
        const V p = cross(d, e2), q = cross(o - corner, e1);
        const Real det = e1 * p, b1 = (o - corner) * p / det, b2 = d * q / det;
        if (b1 >= 0 && b2 >= 0 && (half ? b1 + b2 <= 1 : b1 <= 1 && b2 <= 1))
            take(e2 * q / det, cross(e1, e2), s, l);
    }
    void disk(V o, V d, V centre, V n, Real r, std::uint32_t s) {
        const Real candidate = n * (centre - o) / (n * d);
        const V p = o + candidate * d - centre;
        if (p * p <= r * r)
            take(candidate, n, s, NO_INDEX);
    }
    void rectangle(V o, V d, V centre, V u, V w, std::uint32_t s, std::uint32_t l) {
        parallelogram(o, d, centre - 0.5L * (u + w), u, w, false, s, l);
    }
};

Reference brute_force(const Scene& scene, const RayRecord& ray) {
    const V o{ray.origin_x, ray.origin_y, ray.origin_z};
    const V d{ray.direction_x, ray.direction_y, ray.direction_z};
    Reference best;
    for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
        const auto& g = scene.shapes[i].geometry;
        if (const auto* s = std::get_if<SphereShape>(&g))
            best.sphere(o, d, v(s->centre), s->radius, i, NO_INDEX);
        if (const auto* r = std::get_if<RectangleShape>(&g))
            best.rectangle(o, d, v(r->centre), v(r->edge_u), v(r->edge_v), i, NO_INDEX);
        if (const auto* k = std::get_if<DiskShape>(&g))
            best.disk(o, d, v(k->centre), v(k->normal), k->radius, i);
        if (const auto* m = std::get_if<MeshShape>(&g)) {
            const auto corner = [&](std::size_t n) {
                return V{m->positions[3 * n], m->positions[3 * n + 1], m->positions[3 * n + 2]};
            };
            best.parallelogram(o, d, corner(0), corner(1) - corner(0), corner(2) - corner(0), true,
                               i, NO_INDEX);
        }
    }
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
        if (const auto* r = std::get_if<RectangleLight>(&scene.lights[i]))
            best.rectangle(o, d, v(r->centre), v(r->edge_u), v(r->edge_v), NO_INDEX, i);
        if (const auto* s = std::get_if<SphereLight>(&scene.lights[i]))
            best.sphere(o, d, v(s->centre), s->radius, NO_INDEX, i);
    }
    return best;
}

double distance_between(const HitRecord& hit, V p) {
    const V difference = v(position_of(hit)) - p;
    return static_cast<double>(std::sqrt(difference * difference));
}

} // namespace

TEST(Intersection, AgreesWithTryingEverythingInExtendedPrecision) {
    const Scene scene = random_scene(1);
    const Geometry geometry(scene);
    const auto rays = random_rays(50000, 2);
    const auto hits = trace(geometry, rays);
    std::size_t hit_count = 0, edge_cases = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Reference best = brute_force(scene, rays[i]);
        if (hits[i].shape != best.shape || hits[i].light != best.light) {
            ++edge_cases; // a triangle's border, in single precision
            continue;
        }
        if (!std::isfinite(best.t))
            continue;
        ++hit_count;
        const V p = V{rays[i].origin_x, rays[i].origin_y, rays[i].origin_z} +
                    best.t * V{rays[i].direction_x, rays[i].direction_y, rays[i].direction_z};
        // Coordinates go to 12 and are rounded to single precision: 12 * 2^-24 = 7e-7 each.
        EXPECT_LE(distance_between(hits[i], p), 2e-6) << i;
        EXPECT_NEAR(hits[i].distance, static_cast<double>(best.t), 2e-6 * (1.0 + hits[i].distance));
        // Unit normals in single precision: 3 components of at most 2^-25 each.
        EXPECT_NEAR(static_cast<double>(v(normal_of(hits[i])) * best.normal), 1.0, 3e-7) << i;
        EXPECT_GE(hits[i].position_error, distance_between(hits[i], p) / std::sqrt(3.0)) << i;
    }
    EXPECT_GT(hit_count, rays.size() / 5);
    // The chance that a ray passes within single precision of one of 12 triangles' borders.
    EXPECT_LE(edge_cases, 2u);
}

TEST(Intersection, OwnersAreNamed) {
    Scene scene;
    scene.shapes.push_back(shape_of(SphereShape{{0, 0, 0}, 1.0}, 7));
    scene.lights.push_back(PointLight{});
    scene.lights.push_back(RectangleLight{{0, 5, 0}, {1, 0, 0}, {0, 0, 1}, {}});
    scene.lights.push_back(SphereLight{{0, -5, 0}, 1.0, {}});
    const Geometry geometry(scene);
    const auto hits =
        trace(geometry, {ray_record({0, 0, 5}, {0, 0, -1}), ray_record({0, 3, 0}, {0, 1, 0}),
                         ray_record({0, -3, 0}, {0, -1, 0}), ray_record({0, 0, 5}, {0, 0, 1})});
    EXPECT_EQ(hits[0].shape, 0u);
    EXPECT_EQ(hits[0].material, 7u);
    EXPECT_EQ(hits[0].light, NO_INDEX);
    EXPECT_EQ(hits[1].light, 1u);
    EXPECT_EQ(hits[2].light, 2u);
    for (const int lamp : {1, 2}) {
        EXPECT_EQ(hits[static_cast<std::size_t>(lamp)].shape, NO_INDEX);
        EXPECT_EQ(hits[static_cast<std::size_t>(lamp)].material, NO_INDEX);
    }
    EXPECT_EQ(hits[3].shape, NO_INDEX);
    EXPECT_EQ(hits[3].light, NO_INDEX);
}

TEST(Intersection, SidesAndParametersAreAsDocumented) {
    Scene scene;
    scene.shapes.push_back(shape_of(RectangleShape{{0, 0, 0}, {2, 0, 0}, {0, 4, 0}}));
    scene.shapes.push_back(shape_of(SphereShape{{10, 0, 0}, 2.0}));
    scene.shapes.push_back(shape_of(DiskShape{{20, 0, 0}, {0, 0, -3}, 2.0}));
    const Geometry geometry(scene);
    const auto hits =
        trace(geometry, {ray_record({0.5, 1.0, -5}, {0, 0, 1}), ray_record({10, 5, 0}, {0, -1, 0}),
                         ray_record({10, 0, 0}, {0, 1, 0}), ray_record({21, 0, 5}, {0, 0, -1})});
    // From behind: the normal stays that of cross(edge_u, edge_v).
    EXPECT_EQ(normal_of(hits[0]), (Vector3{0, 0, 1}));
    EXPECT_FLOAT_EQ(hits[0].u, 0.75f);
    EXPECT_FLOAT_EQ(hits[0].v, 0.75f);
    EXPECT_EQ(normal_of(hits[1]), (Vector3{0, 1, 0}));
    EXPECT_FLOAT_EQ(hits[1].u, 0.25f);
    EXPECT_FLOAT_EQ(hits[1].v, 0.5f);
    EXPECT_EQ(normal_of(hits[2]), (Vector3{0, 1, 0})); // outward seen from within too
    EXPECT_FLOAT_EQ(hits[2].distance, 2.0f);
    EXPECT_EQ(normal_of(hits[3]), (Vector3{0, 0, -1}));
    EXPECT_FLOAT_EQ(hits[3].u, 0.5f);
}

TEST(Intersection, ShadingNormalsAreInterpolatedAndStayOnTheGeometricSide) {
    MeshShape mesh;
    mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    mesh.normals = {-1, 0, 1, 1, 0, 1, -1, 0, 1};
    mesh.texture_coordinates = {0, 0, 1, 0, 0, 1};
    mesh.indices = {0, 1, 2};
    MeshShape turned = mesh;
    for (float& x : turned.normals)
        x = -x;
    Scene scene;
    scene.shapes = {shape_of(mesh)};
    Scene flipped;
    flipped.shapes = {shape_of(turned)};
    for (const Scene* s : {&scene, &flipped}) {
        const Geometry geometry(*s);
        const HitRecord hit = trace(geometry, {ray_record({0.25, 0.25, 3}, {0, 0, -1})})[0];
        // Normals (-1,0,1) * 0.75 + (1,0,1) * 0.25 = (-0.5, 0, 1), then unit length.
        EXPECT_NEAR(hit.shading_x, -0.5 / std::sqrt(1.25), 1e-7);
        EXPECT_NEAR(hit.shading_z, 1.0 / std::sqrt(1.25), 1e-7);
        EXPECT_EQ(normal_of(hit), (Vector3{0, 0, 1}));
        EXPECT_FLOAT_EQ(hit.u, 0.25f);
        EXPECT_FLOAT_EQ(hit.v, 0.25f);
    }
}
