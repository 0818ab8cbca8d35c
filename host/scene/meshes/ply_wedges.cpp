#include "host/scene/meshes/ply_wedges.h"

namespace reradiant {

WedgeVertices::WedgeVertices(MeshShape& mesh)
    : mesh_(mesh), has_texture_(mesh.positions.size() / 3, false) {
    mesh_.texture_coordinates.assign(2 * has_texture_.size(), 0.0f);
}

std::uint32_t WedgeVertices::copy(std::uint32_t vertex) {
    const auto made = static_cast<std::uint32_t>(mesh_.positions.size() / 3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        mesh_.positions.push_back(mesh_.positions[3 * std::size_t{vertex} + axis]);
        if (!mesh_.normals.empty())
            mesh_.normals.push_back(mesh_.normals[3 * std::size_t{vertex} + axis]);
    }
    mesh_.texture_coordinates.resize(2 * (std::size_t{made} + 1));
    return made;
}

std::uint32_t WedgeVertices::with_texture(std::uint32_t vertex, float u, float v) {
    float* own = &mesh_.texture_coordinates[2 * std::size_t{vertex}];
    if (has_texture_[vertex]) {
        if (own[0] == u && own[1] == v)
            return vertex;
        const auto [entry, is_new] = copies_.try_emplace({vertex, u, v}, vertex);
        if (!is_new)
            return entry->second;
        entry->second = vertex = copy(vertex);
        own = &mesh_.texture_coordinates[2 * std::size_t{vertex}];
    } else {
        has_texture_[vertex] = true;
    }
    own[0] = u;
    own[1] = v;
    return vertex;
}

} // namespace reradiant
