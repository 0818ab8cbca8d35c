#pragma once

#include "host/geometry/primitives.h"
#include "kernels/core/shared.h"
#include "reradiant/scene.h"

#include <memory>
#include <optional>
#include <vector>

namespace reradiant {

/// An `Owner` says which shape, material and light a surface belongs to.
struct Owner {
    std::uint32_t shape = NO_INDEX, material = NO_INDEX, light = NO_INDEX;
};

/// Primitives of one kind with their owners.
template <typename Primitive>
struct OwnedPrimitives {
    std::vector<Primitive> primitives;
    std::vector<Owner> owners;

    void add(const Primitive& primitive, const Owner& owner) {
        primitives.push_back(primitive);
        owners.push_back(owner);
    }
};

/// A mesh of the scene. Its own are copied, so that a Geometry outlives its Scene; instances share
/// theirs and are moved.
struct OwnedMesh {
    std::shared_ptr<const MeshShape> mesh;
    Owner owner;
    std::optional<Placement> placement;
};

/// Where a ray meets a triangle of a mesh; `fallback` as for TrianglePrimitive::barycentric.
SurfaceHit describe_on_mesh(const OwnedMesh& owned, std::uint32_t index, const Ray& ray,
                            std::array<double, 2> fallback);

/// Every surface of a scene, checked.
struct Surfaces {
    OwnedPrimitives<SpherePrimitive> spheres;
    OwnedPrimitives<RectanglePrimitive> rectangles;
    OwnedPrimitives<DiskPrimitive> disks;
    OwnedPrimitives<CylinderPrimitive> cylinders;
    std::vector<OwnedMesh> meshes;
};

/// Throws an input Error that names shape (or light) and primitive for what Embree would drop or
/// read out of bounds without a word.
Surfaces surfaces_of(const Scene& scene);

} // namespace reradiant
