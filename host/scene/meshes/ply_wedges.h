#pragma once

#include "reradiant/scene.h"

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace reradiant {

/// `WedgeVertices` gives vertices the texture coordinates of the corners of faces (wedges): the
/// first that a vertex meets become its own, and each other pair makes a copy of the vertex.
class WedgeVertices {
public:
    /// Starts from the vertices that the mesh holds now and drops the texture coordinates that they
    /// have.
    explicit WedgeVertices(MeshShape& mesh);

    /// Returns the vertex at the place of `vertex` that has these texture coordinates.
    std::uint32_t with_texture(std::uint32_t vertex, float u, float v);

private:
    std::uint32_t copy(std::uint32_t vertex);

    MeshShape& mesh_;
    std::vector<bool> has_texture_;
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> copies_;
};

} // namespace reradiant
