#include "host/geometry/surfaces.h"

#include <cmath>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr double MAX_COORDINATE = 1e18;

/// Collects surfaces; errors name the scene's file and the surface.
class SurfaceCollector {
public:
    explicit SurfaceCollector(const Scene& scene) : scene_(scene) {}
    Surfaces collect();

private:
    [[noreturn]] void fail(const std::string& wrong, const std::string& remedy) const {
        throw_input_error({scene_.file.string()}, fmt::format("{}: {}", name_, wrong), remedy);
    }
    void check_vector(const Vector3& v, const char* what) const;
    void check_radius(double radius) const;
    void add(const SphereShape& sphere);
    void add(const RectangleShape& rectangle);
    void add(const DiskShape& disk);
    void add(const MeshShape& mesh);

    const Scene& scene_;
    Surfaces surfaces_;
    std::string name_;
    Owner owner_;
};

void SurfaceCollector::check_vector(const Vector3& v, const char* what) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(std::fabs(v[axis]) <= MAX_COORDINATE))
            fail(fmt::format("{} of {} is {}", "xyz"[axis], what, v[axis]),
                 "it must be finite and at most 1e18 in size");
}

void SurfaceCollector::check_radius(double radius) const {
    if (!(radius > 0.0 && radius <= MAX_COORDINATE))
        fail(fmt::format("the radius is {}", radius), "it must be above 0 and at most 1e18");
}

void SurfaceCollector::add(const SphereShape& sphere) {
    check_vector(sphere.centre, "center");
    check_radius(sphere.radius);
    surfaces_.spheres.add({to_vec3(sphere.centre), sphere.radius}, owner_);
}

void SurfaceCollector::add(const RectangleShape& rectangle) {
    check_vector(rectangle.centre, "center");
    check_vector(rectangle.edge_u, "edge_u");
    check_vector(rectangle.edge_v, "edge_v");
    const RectanglePrimitive primitive(rectangle.centre, rectangle.edge_u, rectangle.edge_v);
    const double check = primitive.normal.x + primitive.dual_u.x + primitive.dual_v.x;
    if (!std::isfinite(check))
        fail("the rectangle has no area", "give two edges that are not parallel");
    surfaces_.rectangles.add(primitive, owner_);
}

void SurfaceCollector::add(const DiskShape& disk) {
    check_vector(disk.centre, "center");
    check_vector(disk.normal, "normal");
    check_radius(disk.radius);
    if (disk.normal == Vector3{})
        fail("the normal is zero", "give the direction that the disk faces");
    surfaces_.disks.add(DiskPrimitive(disk.centre, disk.normal, disk.radius), owner_);
}

void SurfaceCollector::add(const MeshShape& mesh) {
    const std::size_t vertices = mesh.positions.size() / 3;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (!(std::fabs(static_cast<double>(mesh.positions[i])) <= MAX_COORDINATE))
            fail(fmt::format("{} of vertex {} is {}", "xyz"[i % 3], i / 3, mesh.positions[i]),
                 "it must be finite and at most 1e18 in size");
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (mesh.indices[i] >= vertices)
            fail(fmt::format("triangle {} refers to vertex {} of {}", i / 3, mesh.indices[i],
                             vertices),
                 "vertices count from 0");
    if (mesh.positions.size() % 3 != 0 || mesh.indices.empty() || mesh.indices.size() % 3 != 0)
        fail("positions and indices are not whole vertices and triangles", "give threes");
    if ((!mesh.normals.empty() && mesh.normals.size() != 3 * vertices) ||
        (!mesh.texture_coordinates.empty() && mesh.texture_coordinates.size() != 2 * vertices))
        fail("normals or texture coordinates are not one a vertex", "give none or all");
    surfaces_.meshes.push_back({mesh, owner_});
}

Surfaces SurfaceCollector::collect() {
    for (std::size_t i = 0; i < scene_.shapes.size(); ++i) {
        const Shape& shape = scene_.shapes[i];
        name_ = fmt::format("shape {}", i);
        owner_ = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(shape.material),
                  NO_INDEX};
        std::visit([&](const auto& geometry) { add(geometry); }, shape.geometry);
    }
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        name_ = fmt::format("light {}", i);
        owner_ = {NO_INDEX, NO_INDEX, static_cast<std::uint32_t>(i)};
        if (const auto* rectangle = std::get_if<RectangleLight>(&scene_.lights[i]))
            add(RectangleShape{rectangle->centre, rectangle->edge_u, rectangle->edge_v});
        else if (const auto* sphere = std::get_if<SphereLight>(&scene_.lights[i]))
            add(SphereShape{sphere->centre, sphere->radius});
    }
    return std::move(surfaces_);
}

} // namespace

Surfaces surfaces_of(const Scene& scene) {
    return SurfaceCollector(scene).collect();
}

} // namespace reradiant
