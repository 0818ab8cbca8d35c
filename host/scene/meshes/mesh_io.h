#pragma once

#include "reradiant/scene.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace reradiant {

/// Reads a mesh by its ending, .ply (ascii, binary little and big endian) or .obj. Faces of
/// more than three corners are cut into triangles (triangulate_polygon). Throws an input Error with
/// line and column (ascii) or byte offset (binary) that names the vertex or face: not finite,
/// beyond 1e18, index out of range, a polygon that crosses itself, truncated, counts that the file
/// cannot hold. Memory is taken in proportion to the file's size, never to a count that it claims.
MeshShape read_mesh(const std::filesystem::path& file);

/// Parses a mesh from bytes that were read, as `read_mesh` does from a file; `file` gives the
/// ending and the name in messages.
MeshShape parse_mesh(const std::filesystem::path& file, std::string_view bytes);
MeshShape parse_ply(const std::filesystem::path& file, std::string_view bytes);
MeshShape parse_obj(const std::filesystem::path& file, std::string_view bytes);

/// Returns the text without its byte-order mark; throws an input Error that names UTF-16 or UTF-32
/// for a text in one of these.
std::string_view without_byte_order_mark(const std::filesystem::path& file, std::string_view bytes);

/// Appends the fan of a convex face whose corners are vertex numbers.
void append_fan(const std::vector<std::uint32_t>& corners, MeshShape& mesh);
/// Appends a face of any form: its vertex numbers and where they lie. Input Error at `at` that
/// names face `number` for a polygon that triangulate_polygon refuses.
void append_face(const std::vector<std::uint32_t>& vertices, std::span<const Vector3> corners,
                 std::uint64_t number, const SourcePosition& at, MeshShape& mesh);

/// Adds normals at the vertices of a mesh that has none: those of its triangles weighted by their
/// angle there (Thuermer and Wuethrich 1998). A vertex of no area gets zero, which means that the
/// normal of the triangle is used for shading.
void add_smooth_normals(MeshShape& mesh);

/// Returns the area of each triangle.
std::vector<double> triangle_areas(const MeshShape& mesh);
/// Returns the area of all triangles.
double mesh_area(const MeshShape& mesh);

/// Returns a coordinate as float; throws an input Error at `at` that names it unless it is finite
/// and at most 1e18 in size.
float mesh_coordinate(double value, const SourcePosition& at, const std::string& name);

} // namespace reradiant
