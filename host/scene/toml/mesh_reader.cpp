#include "host/scene/toml/scene_parts.h"

#include "host/scene/meshes/mesh_io.h"
#include "host/scene/meshes/placement.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

namespace reradiant {

namespace {

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

std::vector<double> numbers_of_key(const TableReader& reader, const std::string& key,
                                   std::size_t count, const std::string& kind) {
    reader.describe(key, kind);
    return numbers_at(reader.required(key), reader.file(), reader.position_of_key(key), key, count,
                      NumberRange::within(-MAX_COORDINATE, MAX_COORDINATE));
}

Eigen::Vector3d read_scale(const TableReader& reader) {
    const std::string kind = "number or array of 3 numbers, not 0";
    reader.describe("scale", kind);
    if (!reader.has("scale"))
        return Eigen::Vector3d::Ones();
    Eigen::Vector3d scale;
    if (reader.required("scale").is_number())
        scale.setConstant(reader.number("scale"));
    else
        scale = Eigen::Vector3d(numbers_of_key(reader, "scale", 3, kind).data());
    if ((scale.array() == 0.0).any())
        reader.fail("scale", "scale is 0: the mesh would be flat", "give factors other than 0");
    return scale;
}

/// Turns about x, then y, then z.
Eigen::Matrix3d read_rotation(const TableReader& reader) {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    const Vector3 degrees = reader.vector_or("rotate_deg", {});
    for (int axis = 0; axis < 3; ++axis)
        turn = Eigen::AngleAxisd(degrees[static_cast<std::size_t>(axis)] * std::numbers::pi / 180.0,
                                 Eigen::Vector3d::Unit(axis))
                   .toRotationMatrix() *
               turn;
    return turn;
}

/// The key `transform`, or `scale`, `rotate_deg` and `translate` in this order, as rows.
std::optional<Matrix34> read_matrix(const TableReader& reader) {
    const std::string kind = "array of 12 numbers";
    reader.describe("transform", kind);
    const Eigen::Vector3d scale = read_scale(reader);
    const Eigen::Matrix3d turn = read_rotation(reader);
    const Vector3 way = reader.vector_or("translate", {});
    if (reader.has("transform")) {
        for (const char* key : {"scale", "rotate_deg", "translate"})
            if (reader.has(key))
                reader.fail(key, fmt::format("both transform and {} are given", key),
                            "give the matrix alone, or scale, rotate_deg and translate");
        return Matrix34(numbers_of_key(reader, "transform", 12, kind).data());
    }
    if (!reader.has("scale") && !reader.has("rotate_deg") && !reader.has("translate"))
        return std::nullopt;
    Matrix34 matrix;
    matrix << turn * scale.asDiagonal(), Eigen::Vector3d(way.data());
    return matrix;
}

const char* key_of_placement(const TableReader& reader) {
    for (const char* key : {"transform", "scale", "rotate_deg"})
        if (reader.has(key))
            return key;
    return "translate";
}

void move_mesh(const TableReader& reader, const Placement& placement, MeshShape& mesh) {
    const SourcePosition at = reader.position_of_key(key_of_placement(reader));
    const auto at_index = [](const std::vector<float>& values, std::size_t k) {
        return kernels::vec3(values[k], values[k + 1], values[k + 2]);
    };
    for (std::size_t k = 0; k + 2 < mesh.positions.size(); k += 3) {
        const kernels::Vec3 moved = placement.point(at_index(mesh.positions, k));
        for (const auto& [axis, value] : {std::pair{0, moved.x}, {1, moved.y}, {2, moved.z}})
            mesh.positions[k + static_cast<std::size_t>(axis)] =
                mesh_coordinate(value, at, "a transformed coordinate");
    }
    for (std::size_t k = 0; k + 2 < mesh.normals.size(); k += 3) {
        const kernels::Vec3 normal = placement.normal(at_index(mesh.normals, k));
        Eigen::Map<Eigen::Vector3f>(&mesh.normals[k]) =
            Eigen::Vector3d(normal.x, normal.y, normal.z).normalized().cast<float>();
    }
}

/// Changes a mesh's normals and coordinates as the flags ask for.
void apply_flags(const TableReader& reader, MeshShape& mesh) {
    if (reader.flag_or("face_normals", false))
        mesh.normals.clear();
    if (reader.flag_or("smooth_normals", false)) {
        if (reader.flag_or("face_normals", false))
            reader.fail("smooth_normals", "smooth_normals stands beside face_normals", "keep one");
        if (mesh.normals.empty())
            add_smooth_normals(mesh);
    }
    if (reader.flag_or("flip_v", false))
        for (std::size_t k = 1; k < mesh.texture_coordinates.size(); k += 2)
            mesh.texture_coordinates[k] = 1.0f - mesh.texture_coordinates[k];
}

/// Reads a mesh's file, which counts for the scene's hash.
MeshShape read_file_of(const std::filesystem::path& file, const SourcePosition& at,
                       LoadState& state) {
    const std::string bytes = read_file(file, at, MAX_MESH_BYTES);
    state.add_to_digest(bytes);
    return parse_mesh(file, bytes);
}

} // namespace

std::optional<std::array<double, 12>> read_placement(const TableReader& reader) {
    const std::optional<Matrix34> matrix = read_matrix(reader);
    if (!matrix)
        return std::nullopt;
    std::array<double, 12> rows{};
    Eigen::Map<Matrix34>(rows.data()) = *matrix;
    try {
        const Placement check(rows);
    } catch (const std::invalid_argument& error) {
        reader.fail(key_of_placement(reader), error.what(), "scale every axis by other than 0");
    }
    return rows;
}

MeshShape read_moved_mesh(const TableReader& reader, LoadState& state) {
    const SourcePosition at = reader.position_of_key("file");
    MeshShape mesh = read_file_of(state.resolve(reader.text("file"), at), at, state);
    if (const auto rows = read_placement(reader))
        move_mesh(reader, Placement(*rows), mesh);
    return mesh;
}

MeshShape read_mesh_key(const TableReader& reader, LoadState& state) {
    MeshShape mesh = read_moved_mesh(reader, state);
    apply_flags(reader, mesh);
    return mesh;
}

MeshInstance read_mesh_instance(const TableReader& reader, LoadState& state) {
    const SourcePosition at = reader.position_of_key("file");
    const std::filesystem::path file = state.resolve(reader.text("file"), at);
    const std::string key = fmt::format("{}{}{}{}", reader.flag_or("face_normals", false),
                                        reader.flag_or("smooth_normals", false),
                                        reader.flag_or("flip_v", false), file.string());
    std::shared_ptr<const MeshShape>& kept = state.shared_meshes[key];
    if (kept == nullptr) {
        MeshShape mesh = read_file_of(file, at, state);
        apply_flags(reader, mesh);
        kept = std::make_shared<const MeshShape>(std::move(mesh));
    }
    constexpr std::array<double, 12> nowhere_else{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    return {kept, read_placement(reader).value_or(nowhere_else)};
}

} // namespace reradiant
