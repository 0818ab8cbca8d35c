#include "host/study/study/sample_scene.h"

#include "host/scene/toml/scene_table.h"
#include "reradiant/error.h"

#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

constexpr double sample_size = 2.0, lamp_size = 0.9, lamp_distance = 12.0;
constexpr double default_angle_deg = 20.0;

/// Seen from 60 away under 2.1 degrees the direction of view hardly varies over the sample.
constexpr const char* fixed_parts = R"(
[camera]
origin = [0, 0, 60]
target = [0, 0, 0]
fov_deg = 2.1
[integrator]
max_depth = 4
[[shape]]
type = "rectangle"
center = [0, 0, 0]
edge_u = [2, 0, 0]
material = "sample"
[[light]]
type = "rectangle"
edge_u = [0.9, 0, 0]
radiance = { illuminant = "D65", scale = 120 }
)";

toml::array vector_of(double x, double y, double z) {
    return toml::array{x, y, z};
}

toml::table& first_of(toml::table& scene, const char* key) {
    return *scene[key].as_array()->get(0)->as_table();
}

} // namespace

void set_sample_angle(toml::table& scene, double angle_deg) {
    const double angle = angle_deg * std::numbers::pi / 180.0;
    const double c = std::cos(angle), s = std::sin(angle);
    const double mirror_c = std::cos(2.0 * angle), mirror_s = std::sin(2.0 * angle);
    first_of(scene, "shape")
        .insert_or_assign("edge_v", vector_of(0, sample_size * c, -sample_size * s));
    toml::table& lamp = first_of(scene, "light");
    lamp.insert_or_assign("center",
                          vector_of(0, lamp_distance * mirror_s, lamp_distance * mirror_c));
    // Turned so that cross(edge_u, edge_v) looks back at the sample.
    lamp.insert_or_assign("edge_v", vector_of(0, -lamp_size * mirror_c, lamp_size * mirror_s));
}

toml::table sample_scene(const std::filesystem::path& material_file, int width, int height) {
    toml::table given = read_scene_table(material_file);
    const toml::table* const material = given["material"].as_table();
    if (material == nullptr)
        throw_input_error({material_file.string()}, "holds no [material]",
                          "give a material file, or a scene as scene = \"...\"");
    toml::table scene = toml::parse(fixed_parts);
    scene.insert("film", toml::table{{"width", width}, {"height", height}});
    toml::table named = *material;
    named.insert_or_assign("name", sample_material);
    scene.insert("material", toml::array{std::move(named)});
    if (const toml::node* const textures = given.get("texture"))
        scene.insert("texture", *textures);
    set_sample_angle(scene, default_angle_deg);
    return scene;
}

} // namespace reradiant
