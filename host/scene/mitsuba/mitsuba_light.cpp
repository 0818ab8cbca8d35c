#include "host/scene/mitsuba/mitsuba_scene.h"

#include "host/base/logging.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

using Vector = Eigen::Vector3d;

toml::table point_light(const MitsubaObject& emitter, MitsubaScene& scene) {
    const Vector at = emitter.transform_or_identity("to_world").block<3, 1>(0, 3);
    toml::table light{{"type", "point"},
                      {"position", toml_vector(emitter.point("position").value_or(at))}};
    light.insert(emitter.key("intensity", "intensity"),
                 mitsuba_emission(emitter, "intensity", scene));
    return light;
}

/// Mitsuba's spots fall linearly in the angle, this program's smoothly in the cosine.
toml::table spot_light(const MitsubaObject& emitter, MitsubaScene& scene) {
    const Eigen::Matrix4d matrix = emitter.transform_or_identity("to_world");
    const double cone = emitter.number_or("cutoff_angle", 20.0);
    const double full = emitter.number_or("beam_width", 0.75 * cone);
    toml::table light{{"type", "spot"},
                      {"position", toml_vector(Vector(matrix.block<3, 1>(0, 3)))},
                      {"direction", toml_vector(Vector(matrix.block<3, 1>(0, 2)))}};
    light.insert(emitter.key("cone_deg", "cutoff_angle"), cone);
    light.insert(emitter.key("falloff_deg", "beam_width"), std::max(0.0, cone - full));
    light.insert(emitter.key("intensity", "intensity"),
                 mitsuba_emission(emitter, "intensity", scene));
    if (full < cone)
        logging::warn("{}: the edge of a spot falls smoothly here, in Mitsuba linearly",
                      scene.document().position(emitter.element()).text());
    return light;
}

toml::table directional_light(const MitsubaObject& emitter, MitsubaScene& scene) {
    const Vector along = emitter.transform_or_identity("to_world").block<3, 1>(0, 2);
    toml::table light{{"type", "directional"}};
    light.insert(emitter.key("direction", "direction"),
                 toml_vector(emitter.point("direction").value_or(along)));
    light.insert(emitter.key("irradiance", "irradiance"),
                 mitsuba_emission(emitter, "irradiance", scene));
    return light;
}

toml::table constant_light(const MitsubaObject& emitter, MitsubaScene& scene) {
    toml::table light{{"type", "environment"}};
    light.insert(emitter.key("radiance", "radiance"), mitsuba_emission(emitter, "radiance", scene));
    return light;
}

/// Returns the degrees of a turn about +y; throws an input Error for any other transform.
double turn_about_y(const MitsubaObject& emitter) {
    const Eigen::Matrix3d turn = emitter.transform_or_identity("to_world").topLeftCorner<3, 3>();
    const double angle = std::atan2(turn(0, 2), turn(2, 2));
    Eigen::Matrix3d expected;
    expected << std::cos(angle), 0.0, std::sin(angle), 0.0, 1.0, 0.0, -std::sin(angle), 0.0,
        std::cos(angle);
    if (!turn.isApprox(expected, 1e-5))
        emitter.document().fail(emitter.find("to_world"),
                                "to_world of an envmap is more than a rotation about y",
                                "turn the scene so that +y is up");
    return angle * 180.0 / std::numbers::pi;
}

toml::table environment_map(const MitsubaObject& emitter, MitsubaScene& scene) {
    // Mitsuba's middle column looks along +z, this program's along -z.
    const double degrees = turn_about_y(emitter) + 180.0;
    emitter.ignore("mis_compensation", "it says how to sample, not what");
    toml::table light{{"type", "environment"}, {"rotation_deg", degrees}};
    light.insert(emitter.key("file", "filename"), scene.file_name(emitter, "filename"));
    toml::table radiance{{"illuminant", "D65"}};
    radiance.insert(emitter.key("scale", "scale"), emitter.number_or("scale", 1.0));
    light.insert(emitter.key("radiance", "scale"), std::move(radiance));
    return light;
}

} // namespace

void add_mitsuba_emitter(const pugi::xml_node& element, MitsubaScene& scene) {
    const MitsubaObject emitter(scene.document(), element);
    toml::table light;
    if (emitter.type() == "point")
        light = point_light(emitter, scene);
    else if (emitter.type() == "spot")
        light = spot_light(emitter, scene);
    else if (emitter.type() == "directional")
        light = directional_light(emitter, scene);
    else if (emitter.type() == "constant")
        light = constant_light(emitter, scene);
    else if (emitter.type() == "envmap")
        light = environment_map(emitter, scene);
    else
        emitter.refuse_type(
            {"area (in a shape)", "point", "spot", "directional", "constant", "envmap"});
    emitter.finish();
    scene.add("light", std::move(light), element);
}

} // namespace reradiant
