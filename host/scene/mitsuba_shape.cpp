#include "host/scene/mitsuba_scene.h"

#include <Eigen/LU>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

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

toml::table geometry(const MitsubaObject& shape, bool flipped, MitsubaScene& scene) {
    const Matrix matrix = shape.transform_or_identity("to_world");
    require_invertible(shape, matrix);
    const std::string& type = shape.type();
    if (type == "sphere")
        return sphere(shape, matrix);
    if (type == "rectangle")
        return rectangle(matrix, flipped);
    if (type == "disk")
        return disk(shape, matrix, flipped);
    if (type == "ply" || type == "obj")
        return mesh(shape, matrix, scene);
    shape.refuse_type({"sphere", "rectangle", "disk", "ply", "obj"});
}

/// A shape that emits becomes a light; its bsdf is left out, lights do not reflect.
void add_area_light(const MitsubaObject& shape, const pugi::xml_node& element, toml::table light,
                    bool flipped, MitsubaScene& scene) {
    const MitsubaObject emitter(scene.document(), element);
    if (emitter.type() != "area")
        emitter.refuse_type({"area"});
    if (shape.type() != "sphere" && shape.type() != "rectangle")
        emitter.fail(fmt::format("a {} that emits is not supported", shape.type()),
                     "let a sphere or a rectangle emit");
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
    toml::table made = geometry(shape, flipped, scene);
    const auto emitters = shape.nested("emitter");
    if (!emitters.empty()) {
        add_area_light(shape, emitters.front(), std::move(made), flipped, scene);
    } else {
        const auto bsdfs = shape.nested("bsdf");
        if (bsdfs.size() > 1)
            shape.fail(fmt::format("the {} has {} bsdfs", shape.title(), bsdfs.size()), "give one");
        made.insert("material", bsdfs.empty() ? mitsuba_default_material(scene)
                                              : mitsuba_material(bsdfs.front(), scene));
        scene.add("shape", std::move(made));
    }
    shape.finish();
}

} // namespace reradiant
