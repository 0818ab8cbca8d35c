#include "host/scene/toml/scene_parts.h"

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

CylinderShape read_cylinder(const TableReader& reader) {
    CylinderShape cylinder{reader.vector("from"), reader.vector("to"),
                           reader.number("radius", RADIUS)};
    if (cylinder.from == cylinder.to)
        reader.fail("to", "both ends of the cylinder are the same", "give two that lie apart");
    return cylinder;
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
    const std::string type = type_of_table(
        table, file, name,
        {"sphere", "rectangle", "disk", "cylinder", "mesh", "instance", "heightfield"});
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
    if (type == "cylinder") {
        const TableReader reader = keys({"from", "to", "radius"});
        return finish(reader, read_cylinder(reader));
    }
    const TableReader reader = keys({"file", "transform", "scale", "rotate_deg", "translate",
                                     "face_normals", "smooth_normals", "flip_v"});
    if (type == "instance")
        return finish(reader, read_mesh_instance(reader, state));
    return finish(reader, read_mesh_key(reader, state));
}

} // namespace reradiant
