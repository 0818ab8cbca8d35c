#pragma once

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"

#include <array>
#include <map>
#include <optional>
#include <vector>

namespace reradiant {

/// Reads a [[light]] table, and the group that it names (or ""); `index` is for messages. A sky is
/// two lights, its sun the second, or one without it.
std::vector<Light> read_lights(const toml::table& table, const std::string& file, std::size_t index,
                               LoadState& state, std::string& group);

/// Reads the keys of a light of type "sky".
std::vector<Light> read_sky(const TableReader& reader, LoadState& state);
const std::vector<std::string>& sky_keys();

/// Reads a [[shape]] table. `materials` maps names to indices into Scene::surfaces.
Shape read_shape(const toml::table& table, const std::string& file, std::size_t index,
                 const std::map<std::string, int>& materials, LoadState& state);

/// A heightfield as a mesh with smooth normals and u, v: the grey values of an image (`file`; a PNG
/// holds 0..1 linearly), times `height`, are heights along the normal of the parallelogram
/// `center`, `edge_u`, `edge_v`. The image lies on it as a texture does.
MeshShape read_heightfield(const TableReader& reader, LoadState& state);

/// Reads the mesh of the key `file`, moved as the keys of `read_placement` say, and no other keys.
MeshShape read_moved_mesh(const TableReader& reader, LoadState& state);
/// Reads the same, and what is to become of normals and coordinates.
MeshShape read_mesh_key(const TableReader& reader, LoadState& state);
/// Reads the same as an instance: files are read, and kept, once.
MeshInstance read_mesh_instance(const TableReader& reader, LoadState& state);

/// Reads `transform`, or `scale`, `rotate_deg` and `translate`: the upper three rows of a matrix,
/// none where no key is given.
std::optional<std::array<double, 12>> read_placement(const TableReader& reader);

/// Reads both edges of a rectangle; fails at the edge that leaves it without an area.
std::array<Vector3, 2> read_edges(const TableReader& reader);

double vector_length(const Vector3& v);
Vector3 vector_cross(const Vector3& a, const Vector3& b);

} // namespace reradiant
