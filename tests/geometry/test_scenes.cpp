#include "tests/geometry/test_scenes.h"

#include <cmath>
#include <limits>
#include <map>

namespace reradiant::testing {

namespace {

std::uint32_t add_vertex(MeshShape& mesh, const Vector3& direction, const Vector3& centre,
                         double radius) {
    const double length = std::sqrt(dot(direction, direction));
    for (std::size_t i = 0; i < 3; ++i)
        mesh.positions.push_back(static_cast<float>(centre[i] + radius * direction[i] / length));
    return static_cast<std::uint32_t>(mesh.positions.size() / 3 - 1);
}

struct Face {
    Vector3 a, b, c;
};

std::vector<Face> icosahedron() {
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    const std::vector<Vector3> v{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                 {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                 {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    std::vector<Face> result;
    for (const auto& f : faces)
        result.push_back({v[static_cast<std::size_t>(f[0])], v[static_cast<std::size_t>(f[1])],
                          v[static_cast<std::size_t>(f[2])]});
    return result;
}

/// Midpoints on the sphere, in an order that does not depend on which face asks: neighbours then
/// share the very same vertex.
Vector3 midpoint(const Vector3& a, const Vector3& b) {
    Vector3 m = sum(a, b, 1.0);
    const double scale = std::sqrt(dot(a, a) / dot(m, m));
    for (double& x : m)
        x *= scale;
    return m;
}

} // namespace

double dot(const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector3 sum(const Vector3& a, const Vector3& b, double b_scale) {
    return {a[0] + b_scale * b[0], a[1] + b_scale * b[1], a[2] + b_scale * b[2]};
}

Vector3 position_of(const HitRecord& hit) {
    return {hit.position_x, hit.position_y, hit.position_z};
}

Vector3 normal_of(const HitRecord& hit) {
    return {hit.normal_x, hit.normal_y, hit.normal_z};
}

Shape shape_of(decltype(Shape::geometry) geometry, int material) {
    return {std::move(geometry), material};
}

MeshShape triangle_sphere(const Vector3& centre, double radius, int levels) {
    auto faces = icosahedron();
    for (int level = 0; level < levels; ++level) {
        std::vector<Face> split;
        for (const Face& f : faces) {
            const Vector3 ab = midpoint(f.a, f.b), bc = midpoint(f.b, f.c), ca = midpoint(f.c, f.a);
            split.insert(split.end(), {{f.a, ab, ca}, {ab, f.b, bc}, {ca, bc, f.c}, {ab, bc, ca}});
        }
        faces = std::move(split);
    }
    MeshShape mesh;
    std::map<Vector3, std::uint32_t> known;
    for (const Face& f : faces)
        for (const Vector3& corner : {f.a, f.b, f.c}) {
            const auto [entry, is_new] = known.try_emplace(corner, 0);
            if (is_new)
                entry->second = add_vertex(mesh, corner, centre, radius);
            mesh.indices.push_back(entry->second);
        }
    return mesh;
}

Vector3 random_direction(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    for (;;) {
        Vector3 v{normal(random), normal(random), normal(random)};
        const double length = std::sqrt(dot(v, v));
        if (length < 1e-6)
            continue;
        for (double& x : v)
            x /= length;
        return v;
    }
}

Scene random_scene(unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-10.0, 10.0), size(0.2, 3.0);
    const auto point = [&] { return Vector3{place(random), place(random), place(random)}; };
    const auto edge = [&] { return sum({}, random_direction(random), size(random)); };
    Scene scene;
    for (int i = 0; i < 12; ++i) {
        scene.shapes.push_back(shape_of(SphereShape{point(), size(random)}, i));
        scene.shapes.push_back(shape_of(RectangleShape{point(), edge(), edge()}, i));
        scene.shapes.push_back(shape_of(DiskShape{point(), edge(), size(random)}, i));
        MeshShape triangle;
        for (int k = 0; k < 3; ++k)
            for (const double x : point())
                triangle.positions.push_back(static_cast<float>(x));
        triangle.indices = {0, 1, 2};
        scene.shapes.push_back(shape_of(triangle, i));
    }
    scene.lights.push_back(PointLight{});
    scene.lights.push_back(RectangleLight{point(), edge(), edge(), {}});
    scene.lights.push_back(SphereLight{point(), size(random), {}});
    return scene;
}

RayRecord ray_record(const Vector3& origin, const Vector3& direction) {
    RayRecord ray{};
    ray.origin_x = static_cast<float>(origin[0]);
    ray.origin_y = static_cast<float>(origin[1]);
    ray.origin_z = static_cast<float>(origin[2]);
    ray.direction_x = static_cast<float>(direction[0]);
    ray.direction_y = static_cast<float>(direction[1]);
    ray.direction_z = static_cast<float>(direction[2]);
    ray.t_far = std::numeric_limits<float>::infinity();
    return ray;
}

std::vector<RayRecord> random_rays(std::size_t count, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-12.0, 12.0);
    std::vector<RayRecord> rays;
    for (std::size_t i = 0; i < count; ++i)
        rays.push_back(
            ray_record({place(random), place(random), place(random)}, random_direction(random)));
    return rays;
}

std::vector<HitRecord> trace(const Geometry& geometry, const std::vector<RayRecord>& rays,
                             bool coherent, int threads) {
    std::vector<HitRecord> hits(rays.size());
    geometry.intersect(rays, hits, coherent, threads);
    return hits;
}

} // namespace reradiant::testing
