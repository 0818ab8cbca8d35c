#include "host/scene/toml/scene_parts.h"

#include "host/scene/meshes/mesh_io.h"

#include <Eigen/LU>

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reradiant {

namespace {

const NumberRange RADIUS{.low = 0.0, .high = MAX_COORDINATE, .low_is_allowed = false};

SphereShape read_sphere(const TableReader& reader) {
    return {reader.vector("center"), reader.number("radius", RADIUS)};
}

RectangleShape read_rectangle(const TableReader& reader) {
    const Vector3 centre = reader.vector("center");
    const auto edges = read_edges(reader);
    return {centre, edges[0], edges[1]};
}

DiskShape read_disk(const TableReader& reader) {
    DiskShape disk{reader.vector("center"), reader.vector("normal"),
                   reader.number("radius", RADIUS)};
    if (!(vector_length(disk.normal) > 0.0))
        reader.fail("normal", "normal is zero", "give the direction that the disk faces");
    return disk;
}

/// Moves a mesh by the key `transform`, which holds the upper three rows of a matrix, row after
/// row, and its normals by the inverse transpose.
void transform_mesh(const TableReader& reader, MeshShape& mesh) {
    reader.describe("transform", "array of 12 numbers");
    const auto values =
        numbers_at(reader.required("transform"), reader.file(), reader.position_of_key("transform"),
                   "transform", 12, NumberRange::within(-MAX_COORDINATE, MAX_COORDINATE));
    const Eigen::Matrix<double, 3, 4> matrix =
        Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(values.data());
    const Eigen::Matrix3d linear = matrix.leftCols<3>();
    const double size = linear.norm();
    if (!(std::abs(linear.determinant()) > 1e-18 * size * size * size))
        reader.fail("transform", "the transform makes the mesh flat",
                    "scale every axis by other than 0");
    const SourcePosition at = reader.position_of_key("transform");
    for (std::size_t k = 0; k + 2 < mesh.positions.size(); k += 3) {
        const Eigen::Vector3f old = Eigen::Map<const Eigen::Vector3f>(&mesh.positions[k]);
        const Eigen::Vector3d moved = linear * old.cast<double>() + matrix.col(3);
        for (int c = 0; c < 3; ++c)
            mesh.positions[k + static_cast<std::size_t>(c)] =
                mesh_coordinate(moved[c], at, "a transformed coordinate");
    }
    // The normals of a mirrored mesh stay on the side that its triangles face.
    const Eigen::Matrix3d normals =
        linear.inverse().transpose() * (linear.determinant() < 0.0 ? -1.0 : 1.0);
    for (std::size_t k = 0; k + 2 < mesh.normals.size(); k += 3) {
        Eigen::Map<Eigen::Vector3f> normal(&mesh.normals[k]);
        normal = (normals * normal.cast<double>()).normalized().cast<float>();
    }
}

MeshShape read_mesh_key(const TableReader& reader, LoadState& state) {
    const SourcePosition at = reader.position_of_key("file");
    const std::filesystem::path file = state.resolve(reader.text("file"), at);
    const std::string bytes = read_file(file, at, MAX_MESH_BYTES);
    state.add_to_digest(bytes);
    MeshShape mesh = parse_mesh(file, bytes);
    if (reader.has("transform"))
        transform_mesh(reader, mesh);
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
    return mesh;
}

int read_material_name(const TableReader& reader, const std::map<std::string, int>& materials) {
    const std::string name = reader.text("material");
    const auto found = materials.find(name);
    if (found != materials.end())
        return found->second;
    std::vector<std::string> names;
    for (const auto& [known, index] : materials)
        names.push_back(known);
    reader.fail("material", fmt::format("no material is called \"{}\"", name),
                names.empty() ? "add a [[material]]"
                              : fmt::format("there are: {}", fmt::join(names, ", ")));
}

} // namespace

double vector_length(const Vector3& v) {
    return std::hypot(v[0], v[1], v[2]);
}

Vector3 vector_cross(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

std::array<Vector3, 2> read_edges(const TableReader& reader) {
    const Vector3 u = reader.vector("edge_u"), v = reader.vector("edge_v");
    const double u_length = vector_length(u), v_length = vector_length(v);
    if (!(u_length > 0.0))
        reader.fail("edge_u", "edge_u is zero: the rectangle has no area", "give the full edge");
    // Thinner than this, single precision cannot tell the normal.
    if (!(vector_length(vector_cross(u, v)) > 1e-6 * u_length * v_length))
        reader.fail("edge_v",
                    v_length > 0.0 ? "edge_v is parallel to edge_u: the rectangle has no area"
                                   : "edge_v is zero: the rectangle has no area",
                    "give two full edges that span the rectangle");
    return {u, v};
}

Shape read_shape(const toml::table& table, const std::string& file, std::size_t index,
                 const std::map<std::string, int>& materials, LoadState& state) {
    const std::string name = fmt::format("[[shape]] {}", index);
    const std::string type =
        type_of_table(table, file, name, {"sphere", "rectangle", "disk", "mesh", "heightfield"});
    const auto keys = [&](std::vector<std::string> own) {
        own.insert(own.end(), {"type", "material"});
        return TableReader(table, file, fmt::format("{} ({})", name, type), own);
    };
    Shape shape;
    const auto finish = [&](const TableReader& reader, auto geometry) {
        shape.geometry = std::move(geometry);
        shape.material = read_material_name(reader, materials);
        return shape;
    };
    if (type == "sphere") {
        const TableReader reader = keys({"center", "radius"});
        return finish(reader, read_sphere(reader));
    }
    if (type == "rectangle") {
        const TableReader reader = keys({"center", "edge_u", "edge_v"});
        return finish(reader, read_rectangle(reader));
    }
    if (type == "disk") {
        const TableReader reader = keys({"center", "normal", "radius"});
        return finish(reader, read_disk(reader));
    }
    if (type == "heightfield") {
        const TableReader reader = keys({"file", "center", "edge_u", "edge_v", "height"});
        return finish(reader, read_heightfield(reader, state));
    }
    const TableReader reader =
        keys({"file", "transform", "face_normals", "smooth_normals", "flip_v"});
    return finish(reader, read_mesh_key(reader, state));
}

} // namespace reradiant
