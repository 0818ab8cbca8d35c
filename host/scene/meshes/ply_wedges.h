#pragma once

#include "reradiant/scene.h"

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace reradiant {

/// Gives vertices the texture coordinates that corners of faces (wedges) have: the first that a
/// vertex meets become its own, others make a copy of it.
class WedgeVertices {
public:
    /// Of the vertices that the mesh holds now. Texture coordinates that they have are dropped.
    explicit WedgeVertices(MeshShape& mesh);

    /// The vertex at the place of `vertex` that has these texture coordinates.
    std::uint32_t with_texture(std::uint32_t vertex, float u, float v);

private:
    std::uint32_t copy(std::uint32_t vertex);

    MeshShape& mesh_;
    std::vector<bool> has_texture_;
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> copies_;
};

} // namespace reradiant
