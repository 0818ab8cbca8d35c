#include "host/scene/mitsuba/mitsuba_scene.h"

#include <fmt/core.h>

namespace reradiant {

namespace {

std::string name_of(const MitsubaObject& object, MitsubaScene& scene) {
    const MitsubaDocument& document = scene.document();
    return scene.unique_name(document.has(object.element(), "id")
                                 ? document.text(object.element(), "id")
                                 : std::string("texture"));
}

/// The one factor that a to_uv scales u and v by.
double uv_scale(const MitsubaObject& texture) {
    const Eigen::Matrix4d matrix = texture.transform_or_identity("to_uv");
    Eigen::Matrix4d plain = Eigen::Matrix4d::Identity();
    plain(0, 0) = plain(1, 1) = matrix(0, 0);
    plain(2, 2) = matrix(2, 2);
    if (!(matrix(0, 0) > 0.0) || !matrix.isApprox(plain, 1e-9))
        texture.document().fail(texture.find("to_uv"), "to_uv is more than a scale",
                                "scale u and v by one factor above 0");
    return matrix(0, 0);
}

void read_bitmap(const MitsubaObject& texture, toml::table& made, MitsubaScene& scene) {
    made.insert("type", "image");
    made.insert("file", scene.file_name(texture, "filename"));
    made.insert("size", 1.0 / uv_scale(texture));
    if (texture.flag_or("raw", false))
        made.insert("linear", true);
    const std::string filter = texture.text_or("filter_type", "bilinear"),
                      wrap = texture.text_or("wrap_mode", "repeat");
    if (filter != "bilinear")
        texture.document().fail(texture.find("filter_type"),
                                fmt::format("filter_type \"{}\" is not supported", filter),
                                "use bilinear");
    if (wrap != "repeat")
        texture.document().fail(texture.find("wrap_mode"),
                                fmt::format("wrap_mode \"{}\" is not supported", wrap),
                                "use repeat");
    texture.ignore("format", "values are single precision");
}

} // namespace

toml::table mitsuba_texture(const pugi::xml_node& element, MitsubaScene& scene) {
    const MitsubaObject texture(scene.document(), element);
    toml::table made;
    const std::string name = name_of(texture, scene);
    made.insert("name", name);
    if (texture.type() == "bitmap") {
        read_bitmap(texture, made, scene);
    } else if (texture.type() == "checkerboard") {
        made.insert("type", "checker");
        made.insert("space", "uv");
        made.insert("size", 0.5 / uv_scale(texture)); // a period holds two squares
        insert_mitsuba_reflectance(made, "low", texture, "color0", 0.4, scene);
        insert_mitsuba_reflectance(made, "high", texture, "color1", 0.2, scene);
    } else {
        texture.refuse_type({"bitmap", "checkerboard"});
    }
    texture.finish();
    scene.texture_met = made["type"].value_or(std::string());
    scene.add("texture", std::move(made), element);
    return toml::table{{"texture", name}};
}

} // namespace reradiant
