#include "host/scene/mitsuba/mitsuba_scene.h"

#include "host/base/logging.h"
#include "host/scene/meshes/mesh_io.h"

#include <Eigen/LU>
#include <fmt/core.h>

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

/// Returns the length that every axis is scaled by; throws an input Error when they differ or are
/// sheared.
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
    const Vector centre = shape.point("center").value_or(Vector::Zero());
    const double radius = shape.number_or("radius", 1.0);
    const Vector moved = matrix.topLeftCorner<3, 3>() * centre + column(matrix, 3);
    toml::table made{{"type", "sphere"}, {"center", toml_vector(moved)}};
    made.insert(shape.key("radius", "radius"), radius * uniform_scale(shape, matrix, 3));
    return made;
}

/// Makes the rectangle -1..1 by -1..1, which faces +z; where it faces the other way the edges of
/// one that emits are swapped.
toml::table rectangle(const Matrix& matrix, bool flipped, bool emits) {
    const bool mirrored = matrix.topLeftCorner<3, 3>().determinant() < 0.0;
    toml::array u = toml_vector(2.0 * column(matrix, 0)), v = toml_vector(2.0 * column(matrix, 1));
    if (emits && flipped != mirrored)
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
            faces.push_back(toml::table{
                {"type", "rectangle"},
                {"center", toml_vector(column(matrix, 3) + side * column(matrix, axis))},
                {"edge_u", toml_vector(2.0 * side * column(matrix, (axis + 1) % 3))},
                {"edge_v", toml_vector(2.0 * column(matrix, (axis + 2) % 3))}});
    return faces;
}

/// Returns a mesh of one parallelogram as a rectangle, or nothing for any other mesh.
std::optional<toml::table> parallelogram(const MitsubaObject& shape, const Matrix& matrix,
                                         bool flipped, const MitsubaScene& scene) {
    const pugi::xml_node name = shape.find("filename");
    const fs::path given = scene.document().text(name, "value");
    const MeshShape mesh = read_mesh(scene.document().file().parent_path() / given);
    if (mesh.indices.size() != 6)
        return std::nullopt;
    const auto corner = [&](std::size_t k) -> Vector {
        const Eigen::Vector3f at =
            Eigen::Map<const Eigen::Vector3f>(&mesh.positions[3 * mesh.indices[k]]);
        return matrix.topLeftCorner<3, 3>() * at.cast<double>() + column(matrix, 3);
    };
    // The corner of the one triangle that the other has not, and the other way round.
    const auto lonely = [&](std::size_t first, std::size_t other) {
        for (std::size_t k = first; k < first + 3; ++k)
            if (!corner(k).isApprox(corner(other), 1e-6) &&
                !corner(k).isApprox(corner(other + 1), 1e-6) &&
                !corner(k).isApprox(corner(other + 2), 1e-6))
                return k;
        return first;
    };
    const std::size_t near = lonely(0, 3);
    const Vector middle = corner(near), before = corner((near + 2) % 3),
                 after = corner((near + 1) % 3);
    const Vector u = middle - before, v = after - middle;
    if (!(before + v).isApprox(corner(lonely(3, 0)), 1e-5))
        return std::nullopt;
    toml::array edge_u = toml_vector(u), edge_v = toml_vector(v);
    if (flipped)
        std::swap(edge_u, edge_v);
    return toml::table{{"type", "rectangle"},
                       {"center", toml_vector(before + 0.5 * (u + v))},
                       {"edge_u", std::move(edge_u)},
                       {"edge_v", std::move(edge_v)}};
}

toml::table mesh(const MitsubaObject& shape, const Matrix& matrix, MitsubaScene& scene) {
    toml::table made{{"type", "mesh"}, {"file", scene.file_name(shape, "filename")}};
    // Without face_normals Mitsuba computes the normals that a file has not.
    made.insert(shape.flag_or("face_normals", false) ? "face_normals" : "smooth_normals", true);
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

/// Mitsuba's images begin at v = 0 with their top row, this program's with the bottom row; squares
/// of a checkerboard lie alike.
void fit_texture(const MitsubaObject& shape, const std::string& texture, toml::table& part) {
    if (texture.empty())
        return;
    const bool flips_file = shape.flag_or("flip_tex_coords", shape.type() == "obj");
    const std::string form = part["type"].value_or(std::string());
    if (form == "mesh") {
        if (flips_file != (texture == "image"))
            part.insert("flip_v", true);
    } else if (shape.type() != "rectangle") {
        shape.fail(fmt::format("a texture on a {} is not supported", shape.type()),
                   "use a rectangle or a mesh");
    } else if (texture == "image") { // its other side looks the same
        for (toml::node& node : *part["edge_v"].as_array())
            node.ref<double>() *= -1.0;
    }
}

/// Returns the tables of the shapes that a Mitsuba shape is made of, each with its type.
std::vector<toml::table> geometry(const MitsubaObject& shape, bool flipped, MitsubaScene& scene) {
    const Matrix matrix = shape.transform_or_identity("to_world");
    require_invertible(shape, matrix);
    const std::string& type = shape.type();
    if (type == "sphere")
        return {sphere(shape, matrix)};
    if (type == "rectangle")
        return {rectangle(matrix, flipped, !shape.nested("emitter").empty())};
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
    const bool is_mesh = light["type"].value_or(std::string()) == "mesh";
    if ((shape.type() == "sphere" || is_mesh) && flipped)
        emitter.fail(
            fmt::format("a {} that emits inwards is not supported", is_mesh ? "mesh" : "sphere"),
            "let it emit outwards");
    light.erase("smooth_normals"); // what emits has no use for them
    light.erase("face_normals");
    light.insert(emitter.key("radiance", "radiance"), mitsuba_emission(emitter, "radiance", scene));
    emitter.finish();
    const auto bsdfs = shape.nested("bsdf");
    if (!bsdfs.empty())
        logging::warn("{}: the bsdf of a shape that emits is left out: lights reflect nothing",
                      scene.document().position(bsdfs.front()).text());
    scene.add("light", std::move(light), shape.element());
}

} // namespace

void add_mitsuba_shape(const pugi::xml_node& element, MitsubaScene& scene) {
    const MitsubaObject shape(scene.document(), element);
    const bool flipped = shape.flag_or("flip_normals", false);
    std::vector<toml::table> parts = geometry(shape, flipped, scene);
    shape.flag_or("flip_tex_coords", false); // matters to textures alone
    const auto emitters = shape.nested("emitter"), bsdfs = shape.nested("bsdf");
    if (bsdfs.size() > 1 || emitters.size() > 1)
        shape.fail(fmt::format("the {} has {} bsdfs and {} emitters", shape.title(), bsdfs.size(),
                               emitters.size()),
                   "give at most one of each");
    if (emitters.empty()) {
        const std::string material = bsdfs.empty() ? mitsuba_default_material(scene)
                                                   : mitsuba_material(bsdfs.front(), scene);
        for (toml::table& part : parts) {
            fit_texture(shape, scene.material_textures[material], part);
            part.insert("material", material);
            scene.add("shape", std::move(part), element);
        }
    } else {
        for (toml::table& part : parts)
            add_area_light(shape, emitters.front(), std::move(part), flipped, scene);
    }
    shape.finish();
}

} // namespace reradiant
