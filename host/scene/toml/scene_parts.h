#pragma once

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"

#include <map>

namespace reradiant {

/// Reads a [[light]] table, and the group that it names (or ""); `index` is for messages.
Light read_light(const toml::table& table, const std::string& file, std::size_t index,
                 LoadState& state, std::string& group);

/// Reads a [[shape]] table. `materials` maps names to indices into Scene::surfaces.
Shape read_shape(const toml::table& table, const std::string& file, std::size_t index,
                 const std::map<std::string, int>& materials, LoadState& state);

/// A heightfield as a mesh with smooth normals and u, v: the grey values of an image (`file`; a PNG
/// holds 0..1 linearly), times `height`, are heights along the normal of the parallelogram
/// `center`, `edge_u`, `edge_v`. The image lies on it as a texture does.
MeshShape read_heightfield(const TableReader& reader, LoadState& state);

/// Reads both edges of a rectangle; fails at the edge that leaves it without an area.
std::array<Vector3, 2> read_edges(const TableReader& reader);

double vector_length(const Vector3& v);
Vector3 vector_cross(const Vector3& a, const Vector3& b);

} // namespace reradiant
