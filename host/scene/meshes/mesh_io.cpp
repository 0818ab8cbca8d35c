#include "host/scene/meshes/mesh_io.h"

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"
#include "host/scene/meshes/polygon.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/core.h>

namespace reradiant {

MeshShape read_mesh(const std::filesystem::path& file) {
    return parse_mesh(file, read_file(file, {file.string()}, MAX_MESH_BYTES));
}

MeshShape parse_mesh(const std::filesystem::path& file, std::string_view bytes) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending != ".ply" && ending != ".obj")
        throw_input_error({file.string()},
                          fmt::format("\"{}\" is not the ending of a mesh file", ending),
                          "give a .ply or .obj file");
    bytes = without_byte_order_mark(file, bytes);
    MeshShape mesh = ending == ".ply" ? parse_ply(file, bytes) : parse_obj(file, bytes);
    mesh.file = file;
    if (mesh.indices.empty())
        throw_input_error({file.string()}, "the mesh has no faces",
                          "give at least one face that has an area");
    return mesh;
}

std::string_view without_byte_order_mark(const std::filesystem::path& file,
                                         std::string_view bytes) {
    using namespace std::string_view_literals;
    for (const std::string_view mark : {"\xff\xfe"sv, "\xfe\xff"sv, "\0\0\xfe\xff"sv})
        if (bytes.starts_with(mark))
            throw_input_error({file.string(), 1, 1}, "the text is UTF-16 or UTF-32",
                              "save it as UTF-8");
    if (bytes.starts_with("\xef\xbb\xbf"))
        bytes.remove_prefix(3);
    return bytes;
}

void append_fan(const std::vector<std::uint32_t>& corners, MeshShape& mesh) {
    for (std::size_t i = 2; i < corners.size(); ++i)
        mesh.indices.insert(mesh.indices.end(), {corners[0], corners[i - 1], corners[i]});
}

void append_face(const std::vector<std::uint32_t>& vertices, std::span<const Vector3> corners,
                 std::uint64_t number, const SourcePosition& at, MeshShape& mesh) {
    if (vertices.size() == 3)
        return append_fan(vertices, mesh);
    try {
        for (const std::uint32_t corner : triangulate_polygon(corners))
            mesh.indices.push_back(vertices[corner]);
    } catch (const std::invalid_argument& error) {
        throw_input_error(at, fmt::format("face {} {}", number, error.what()),
                          "cut it into polygons that do not");
    }
}

void add_smooth_normals(MeshShape& mesh) {
    const auto corner = [&](std::uint32_t vertex) {
        return Eigen::Vector3f::Map(&mesh.positions[3 * std::size_t{vertex}]).cast<double>().eval();
    };
    std::vector<Eigen::Vector3d> sums(mesh.positions.size() / 3, Eigen::Vector3d::Zero());
    for (std::size_t face = 0; face + 2 < mesh.indices.size(); face += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t here = mesh.indices[face + k];
            const Eigen::Vector3d u = corner(mesh.indices[face + (k + 1) % 3]) - corner(here),
                                  v = corner(mesh.indices[face + (k + 2) % 3]) - corner(here);
            const Eigen::Vector3d normal = u.cross(v);
            const double size = normal.norm();
            if (size > 0.0)
                sums[here] += normal / size * std::atan2(size, u.dot(v));
        }
    mesh.normals.clear();
    for (const Eigen::Vector3d& sum : sums) {
        const double size = sum.norm();
        for (int axis = 0; axis < 3; ++axis)
            mesh.normals.push_back(size > 0.0 ? static_cast<float>(sum[axis] / size) : 0.0f);
    }
}

float mesh_coordinate(double value, const SourcePosition& at, const std::string& name) {
    if (!std::isfinite(value) || std::fabs(value) > MAX_COORDINATE)
        throw_input_error(at, fmt::format("{} is {}", name, value),
                          fmt::format("it must be finite and at most {} in size", MAX_COORDINATE));
    return static_cast<float>(value);
}

std::vector<double> triangle_areas(const MeshShape& mesh) {
    const auto corner = [&](std::size_t index) {
        return Eigen::Map<const Eigen::Vector3f>(
                   &mesh.positions[3 * std::size_t{mesh.indices[index]}])
            .cast<double>();
    };
    std::vector<double> areas;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Eigen::Vector3d first = corner(i), u = corner(i + 1) - first,
                              v = corner(i + 2) - first;
        areas.push_back(0.5 * u.cross(v).norm());
    }
    return areas;
}

double mesh_area(const MeshShape& mesh) {
    const std::vector<double> areas = triangle_areas(mesh);
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

} // namespace reradiant
