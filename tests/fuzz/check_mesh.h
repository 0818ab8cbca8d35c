#pragma once

#include "reradiant/scene.h"
#include "tests/fuzz/fuzz_input.h"

namespace reradiant::fuzz {

/// A mesh that a reader returned is one that Embree may see: whole triangles of vertices that are
/// there, and every number finite.
inline void check_mesh(const MeshShape& mesh) {
    const std::size_t vertices = mesh.positions.size() / 3;
    if (mesh.indices.empty() || mesh.indices.size() % 3 != 0 || mesh.positions.size() % 3 != 0)
        fail("a mesh that is not made of triangles");
    for (const std::uint32_t index : mesh.indices)
        if (index >= vertices)
            fail("an index beyond the last vertex");
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        fail("another number of normals than of vertices");
    if (!mesh.texture_coordinates.empty() && mesh.texture_coordinates.size() != 2 * vertices)
        fail("another number of texture coordinates than of vertices");
    require_all_finite(mesh.positions, "coordinate of a vertex");
    require_all_finite(mesh.normals, "normal of a vertex");
    require_all_finite(mesh.texture_coordinates, "texture coordinate");
}

} // namespace reradiant::fuzz
