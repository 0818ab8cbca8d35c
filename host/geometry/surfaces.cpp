#include "host/geometry/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

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
    void check_mesh(const MeshShape& mesh) const;
    void add(const SphereShape& sphere);
    void add(const RectangleShape& rectangle);
    void add(const DiskShape& disk);
    void add(const MeshShape& mesh);
    void add(const CylinderShape& cylinder);
    void add(const MeshInstance& instance);
    void add(const RectangleLight& light) {
        add(RectangleShape{light.centre, light.edge_u, light.edge_v});
    }
    void add(const SphereLight& light) { add(SphereShape{light.centre, light.radius}); }
    void add(const DiskLight& light) { add(DiskShape{light.centre, light.normal, light.radius}); }
    void add(const MeshLight& light) { add(light.mesh); }
    template <typename Light>
    void add(const Light&) {} // has no surface

    const Scene& scene_;
    Surfaces surfaces_;
    std::string name_;
    Owner owner_;
    std::set<const MeshShape*> checked_; ///< that instances share
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

void SurfaceCollector::add(const CylinderShape& cylinder) {
    check_vector(cylinder.from, "from");
    check_vector(cylinder.to, "to");
    check_radius(cylinder.radius);
    const CylinderPrimitive primitive(cylinder.from, cylinder.to, cylinder.radius);
    if (!(primitive.length > 0.0))
        fail("both ends of the cylinder are the same", "give two ends that lie apart");
    surfaces_.cylinders.add(primitive, owner_);
}

void SurfaceCollector::add(const MeshShape& mesh) {
    check_mesh(mesh);
    surfaces_.meshes.push_back({std::make_shared<const MeshShape>(mesh), owner_, {}});
}

void SurfaceCollector::add(const MeshInstance& instance) {
    if (instance.mesh == nullptr)
        fail("the instance has no mesh", "give one");
    if (checked_.insert(instance.mesh.get()).second)
        check_mesh(*instance.mesh);
    for (const double number : instance.transform)
        if (!(std::fabs(number) <= MAX_COORDINATE))
            fail(fmt::format("the transform holds {}", number),
                 "its numbers must be finite and at most 1e18 in size");
    // Embree holds the matrix in single precision, and so does the description of a hit.
    std::array<double, 12> rounded{};
    std::transform(instance.transform.begin(), instance.transform.end(), rounded.begin(),
                   [](double number) { return static_cast<float>(number); });
    try {
        surfaces_.meshes.push_back({instance.mesh, owner_, Placement(rounded)});
    } catch (const std::invalid_argument& error) {
        fail(error.what(), "scale every axis by other than 0");
    }
}

void SurfaceCollector::check_mesh(const MeshShape& mesh) const {
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
        std::visit([&](const auto& light) { add(light); }, scene_.lights[i]);
    }
    return std::move(surfaces_);
}

} // namespace

SurfaceHit describe_on_mesh(const OwnedMesh& owned, std::uint32_t index, const Ray& ray,
                            std::array<double, 2> fallback) {
    TrianglePrimitive triangle = triangle_of(*owned.mesh, index);
    if (owned.placement)
        for (Vec3& corner : triangle.corners)
            corner = owned.placement->point(corner);
    const auto barycentric = triangle.barycentric(ray, fallback);
    SurfaceHit hit = triangle.describe(ray, barycentric);
    interpolate_vertex_data(*owned.mesh, index, barycentric,
                            owned.placement ? &*owned.placement : nullptr, hit);
    if (owned.placement)
        hit.position_error += owned.placement->rounding_at(hit.position);
    return hit;
}

Surfaces surfaces_of(const Scene& scene) {
    return SurfaceCollector(scene).collect();
}

} // namespace reradiant
