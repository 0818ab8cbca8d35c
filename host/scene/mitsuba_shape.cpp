#include "host/scene/mesh_io.h"
#include "host/scene/mitsuba_scene.h"

#include <Eigen/LU>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace reradiant {

namespace {

namespace fs = std::filesystem;
using Matrix = Eigen::Matrix4d;
using Vector = Eigen::Vector3d;

constexpr double relative_tolerance = 1e-5; // files hold single precision

Vector column(const Matrix& matrix, int k) {
    return matrix.block<3, 1>(0, k);
}

/// The length that every axis is scaled by; input Error when they differ or are sheared.
double uniform_scale(const MitsubaObject& shape, const Matrix& matrix, int axes) {
    const double scale = column(matrix, 0).norm();
    for (int k = 0; k < axes; ++k)
        for (int j = 0; j <= k; ++j) {
            const double expected = j == k ? scale * scale : 0.0;
            if (!(std::abs(column(matrix, k).dot(column(matrix, j)) - expected) <=
                  relative_tolerance * scale * scale))
                shape.fail(fmt::format("to_world stretches the {}", shape.title()),
                           "scale every axis alike, or use a mesh");
        }
    if (!(scale > 0.0))
        shape.fail(fmt::format("to_world makes the {} vanish", shape.title()), "scale by above 0");
    return scale;
}

toml::table sphere(const MitsubaObject& shape, const Matrix& matrix) {
    const Vector center = shape.point("center").value_or(Vector::Zero());
    const double radius = shape.number_or("radius", 1.0);
    const Vector moved = matrix.topLeftCorner<3, 3>() * center + column(matrix, 3);
    return toml::table{{"type", "sphere"},
                       {"center", toml_vector(moved)},
                       {"radius", radius * uniform_scale(shape, matrix, 3)}};
}

/// -1..1 by -1..1, facing +z; edges are turned over where it faces the other way.
toml::table rectangle(const Matrix& matrix, bool flipped) {
    const bool mirrored = matrix.topLeftCorner<3, 3>().determinant() < 0.0;
    toml::array u = toml_vector(2.0 * column(matrix, 0)), v = toml_vector(2.0 * column(matrix, 1));
    if (flipped != mirrored)
        std::swap(u, v);
    return toml::table{{"type", "rectangle"},
                       {"center", toml_vector(column(matrix, 3))},
                       {"edge_u", std::move(u)},
                       {"edge_v", std::move(v)}};
}

toml::table disk(const MitsubaObject& shape, const Matrix& matrix, bool flipped) {
    const double radius = uniform_scale(shape, matrix, 2);
    const Vector normal = (matrix.topLeftCorner<3, 3>().inverse().transpose() * Vector::UnitZ()) *
                          (flipped ? -1.0 : 1.0);
    return toml::table{{"type", "disk"},
                       {"center", toml_vector(column(matrix, 3))},
                       {"normal", toml_vector(normal.normalized())},
                       {"radius", radius}};
}

/// The six faces of the cube from -1 to 1.
std::vector<toml::table> cube(const Matrix& matrix) {
    std::vector<toml::table> faces;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            faces.push_back(
                {{"type", "rectangle"},
                 {"center", toml_vector(column(matrix, 3) + side * column(matrix, axis))},
                 {"edge_u", toml_vector(2.0 * side * column(matrix, (axis + 1) % 3))},
                 {"edge_v", toml_vector(2.0 * column(matrix, (axis + 2) % 3))}});
    return faces;
}

/// A mesh of one parallelogram as a rectangle; empty for any other.
std::optional<toml::table> parallelogram(const MitsubaObject& shape, const Matrix& matrix,
                                         bool flipped, const MitsubaScene& scene) {
    const pugi::xml_node name = shape.find("filename");
    const fs::path given = scene.document().text(name, "value");
    const MeshShape mesh = read_mesh(scene.document().file().parent_path() / given);
    std::vector<Vector> corners; // in the order around that two triangles of one quad have
    for (const std::uint32_t index : mesh.indices) {
        const Eigen::Vector3f at = Eigen::Map<const Eigen::Vector3f>(&mesh.positions[3 * index]);
        const Vector corner = matrix.topLeftCorner<3, 3>() * at.cast<double>() + column(matrix, 3);
        if (std::none_of(corners.begin(), corners.end(),
                         [&](const Vector& known) { return known.isApprox(corner, 1e-6); }))
            corners.push_back(corner);
    }
    if (mesh.indices.size() != 6 || corners.size() != 4)
        return std::nullopt;
    const Vector u = corners[1] - corners[0], v = corners[2] - corners[1];
    if (!(corners[3] - corners[0]).isApprox(v, 1e-5))
        return std::nullopt;
    toml::array edge_u = toml_vector(u), edge_v = toml_vector(v);
    if (flipped)
        std::swap(edge_u, edge_v);
    return toml::table{{"type", "rectangle"},
                       {"center", toml_vector(corners[0] + 0.5 * (u + v))},
                       {"edge_u", std::move(edge_u)},
                       {"edge_v", std::move(edge_v)}};
}

toml::table mesh(const MitsubaObject& shape, const Matrix& matrix, MitsubaScene& scene) {
    toml::table made{{"type", "mesh"}, {"file", scene.file_name(shape, "filename")}};
    if (shape.flag_or("face_normals", false))
        made.insert("face_normals", true);
    shape.flag_or("flip_tex_coords", true); // checked against the renderer's v by the tests
    if (!matrix.isIdentity(0.0)) {
        toml::array values;
        for (int row = 0; row < 3; ++row)
            for (int k = 0; k < 4; ++k)
                values.push_back(matrix(row, k));
        made.insert("transform", std::move(values));
    }
    return made;
}

void require_invertible(const MitsubaObject& shape, const Matrix& matrix) {
    const double size = matrix.topLeftCorner<3, 3>().norm();
    if (!(std::abs(matrix.topLeftCorner<3, 3>().determinant()) > 1e-18 * size * size * size))
        shape.fail(fmt::format("to_world makes the {} flat", shape.title()),
                   "scale every axis by other than 0");
}

/// What a shape is made of, each with its type.
std::vector<toml::table> geometry(const MitsubaObject& shape, bool flipped, MitsubaScene& scene) {
    const Matrix matrix = shape.transform_or_identity("to_world");
    require_invertible(shape, matrix);
    const std::string& type = shape.type();
    if (type == "sphere")
        return {sphere(shape, matrix)};
    if (type == "rectangle")
        return {rectangle(matrix, flipped)};
    if (type == "disk")
        return {disk(shape, matrix, flipped)};
    if (type == "cube")
        return cube(matrix);
    if (type != "ply" && type != "obj")
        shape.refuse_type({"sphere", "rectangle", "disk", "cube", "ply", "obj"});
    toml::table made = mesh(shape, matrix, scene);
    if (!shape.nested("emitter").empty())
        if (auto light = parallelogram(shape, matrix, flipped, scene))
            return {std::move(*light)};
    return {std::move(made)};
}

/// A shape that emits becomes a light; its bsdf is left out, lights do not reflect.
void add_area_light(const MitsubaObject& shape, const pugi::xml_node& element, toml::table light,
                    bool flipped, MitsubaScene& scene) {
    const MitsubaObject emitter(scene.document(), element);
    if (emitter.type() != "area")
        emitter.refuse_type({"area"});
    const std::string form = light["type"].value_or(std::string());
    if (form != "sphere" && form != "rectangle")
        shape.fail(fmt::format("a {} that emits is not supported", shape.type()),
                   "let a sphere, a rectangle or a mesh of one parallelogram emit");
    if (shape.type() == "sphere" && flipped)
        emitter.fail("a sphere that emits inwards is not supported", "let it emit outwards");
    light.insert("radiance", mitsuba_emission(emitter, "radiance", scene));
    emitter.finish();
    const auto bsdfs = shape.nested("bsdf");
    if (!bsdfs.empty())
        spdlog::warn("{}: the bsdf of a shape that emits is left out: lights reflect nothing",
                     scene.document().position(bsdfs.front()).text());
    scene.add("light", std::move(light));
}

} // namespace

void add_mitsuba_shape(const pugi::xml_node& element, MitsubaScene& scene) {
    const MitsubaObject shape(scene.document(), element);
    const bool flipped = shape.flag_or("flip_normals", false);
    std::vector<toml::table> parts = geometry(shape, flipped, scene);
    const auto emitters = shape.nested("emitter"), bsdfs = shape.nested("bsdf");
    if (bsdfs.size() > 1 || emitters.size() > 1)
        shape.fail(fmt::format("the {} has {} bsdfs and {} emitters", shape.title(), bsdfs.size(),
                               emitters.size()),
                   "give at most one of each");
    if (emitters.empty()) {
        const std::string material = bsdfs.empty() ? mitsuba_default_material(scene)
                                                   : mitsuba_material(bsdfs.front(), scene);
        for (toml::table& part : parts) {
            part.insert("material", material);
            scene.add("shape", std::move(part));
        }
    } else {
        for (toml::table& part : parts)
            add_area_light(shape, emitters.front(), std::move(part), flipped, scene);
    }
    shape.finish();
}

} // namespace reradiant
