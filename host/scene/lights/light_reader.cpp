#include "host/scene/toml/scene_parts.h"

#include "host/scene/images/image_io.h"
#include "host/scene/meshes/mesh_io.h"
#include "host/scene/toml/spectrum_reader.h"
#include "reradiant/colour.h"

#include <algorithm>

#include <fmt/core.h>

namespace reradiant {

namespace {

const NumberRange RADIUS{.low = 0.0, .high = MAX_COORDINATE, .low_is_allowed = false};

/// Reads the direction from `place` to the point `target`.
Vector3 read_aim(const TableReader& reader, const Vector3& place) {
    Vector3 way = reader.vector("target");
    for (std::size_t axis = 0; axis < 3; ++axis)
        way[axis] -= place[axis];
    if (!(vector_length(way) > 0.0))
        reader.fail("target", "the light stands at its target", "move one of them");
    return way;
}

/// Reads the direction of a light: the key itself, or towards the key `target`.
Vector3 read_direction(const TableReader& reader, const char* key, const Vector3& place) {
    reader.describe(key, "array of 3 numbers");
    reader.describe("target", "array of 3 numbers");
    if (reader.has("target") && reader.has(key))
        reader.fail("target", fmt::format("both target and {} are given", key), "keep one");
    if (reader.has("target"))
        return read_aim(reader, place);
    const Vector3 direction = reader.vector(key);
    if (!(vector_length(direction) > 0.0))
        reader.fail(key, fmt::format("{} is zero", key), "give a direction, or a target");
    return direction;
}

/// Edges of a rectangle of `size` that faces its `target`: edge_u is level (along +x where the
/// rectangle faces straight up or down), edge_v across it, its upper end up.
std::array<Vector3, 2> read_aimed_edges(const TableReader& reader, const Vector3& centre) {
    for (const char* key : {"edge_u", "edge_v"})
        if (reader.has(key))
            reader.fail(key, fmt::format("both target and {} are given", key),
                        "give target and size, or both edges");
    const Vector3 facing = read_aim(reader, centre);
    reader.describe("size", "array of 2 numbers, above 0");
    const auto size =
        numbers_at(reader.required("size"), reader.file(), reader.position_of_key("size"), "size",
                   2, NumberRange{.low = 0.0, .high = MAX_COORDINATE, .low_is_allowed = false});
    Vector3 u{facing[2], 0.0, -facing[0]}; // +y cross facing
    if (!(vector_length(u) > 1e-6 * vector_length(facing)))
        u = {1.0, 0.0, 0.0};
    Vector3 v = vector_cross(facing, u);
    for (const auto& [edge, length] : {std::pair{&u, size[0]}, {&v, size[1]}}) {
        const double now = vector_length(*edge);
        for (double& part : *edge)
            part *= length / now;
    }
    return {u, v};
}

Light read_rectangle_light(const TableReader& reader, LoadState& state) {
    RectangleLight light;
    light.centre = reader.vector("center");
    reader.describe("target", "array of 3 numbers");
    if (!reader.has("target") && reader.has("size"))
        reader.fail("size", "size is given without a target", "give both edges, or a target");
    const auto edges =
        reader.has("target") ? read_aimed_edges(reader, light.centre) : read_edges(reader);
    light.edge_u = edges[0];
    light.edge_v = edges[1];
    light.radiance = read_spectrum_key(reader, "radiance", SpectrumLimits::emission(), state);
    return light;
}

Light read_sphere_light(const TableReader& reader, LoadState& state) {
    SphereLight light;
    light.centre = reader.vector("center");
    light.radius = reader.number("radius", RADIUS);
    light.radiance = read_spectrum_key(reader, "radiance", SpectrumLimits::emission(), state);
    return light;
}

Light read_disk_light(const TableReader& reader, LoadState& state) {
    DiskLight light;
    light.centre = reader.vector("center");
    light.normal = read_direction(reader, "normal", light.centre);
    light.radius = reader.number("radius", RADIUS);
    light.radiance = read_spectrum_key(reader, "radiance", SpectrumLimits::emission(), state);
    return light;
}

Light read_mesh_light(const TableReader& reader, LoadState& state) {
    MeshLight light;
    light.mesh = read_moved_mesh(reader, state);
    light.mesh.normals.clear();             // what it sends out does not hang on them,
    light.mesh.texture_coordinates.clear(); // nor on these
    if (!(mesh_area(light.mesh) > 0.0))
        reader.fail("file", "the mesh has no area, and sends out no light",
                    "give triangles whose corners do not lie on one line");
    light.radiance = read_spectrum_key(reader, "radiance", SpectrumLimits::emission(), state);
    return light;
}

Light read_spot_light(const TableReader& reader, LoadState& state) {
    SpotLight light;
    light.position = reader.vector("position");
    light.direction = read_direction(reader, "direction", light.position);
    light.cone_deg = reader.number_or("cone_deg", light.cone_deg,
                                      {.low = 0.0, .high = 180.0, .low_is_allowed = false});
    light.falloff_deg = reader.number_or("falloff_deg", std::min(light.falloff_deg, light.cone_deg),
                                         NumberRange::within(0.0, light.cone_deg));
    light.intensity = read_spectrum_key(reader, "intensity", SpectrumLimits::emission(), state);
    return light;
}

Light read_directional_light(const TableReader& reader, LoadState& state) {
    DirectionalLight light;
    light.direction = reader.vector("direction");
    if (!(vector_length(light.direction) > 0.0))
        reader.fail("direction", "direction is zero", "give the way that the light travels");
    light.angle_deg =
        reader.number_or("angle_deg", 0.0, {.low = 0.0, .high = 180.0, .high_is_allowed = false});
    light.irradiance = read_spectrum_key(reader, "irradiance", SpectrumLimits::emission(), state);
    return light;
}

Light read_environment_light(const TableReader& reader, LoadState& state) {
    EnvironmentLight light;
    if (!reader.has("file")) {
        if (reader.has("rotation_deg"))
            reader.fail("rotation_deg", "rotation_deg turns an image, and there is none",
                        "add file = \"sky.exr\"");
        light.radiance = read_spectrum_key(reader, "radiance", SpectrumLimits::emission(), state);
        return light;
    }
    // The rgb basis reproduces a texel's colour under D65, so this is the image as it looks.
    light.radiance = reader.has("radiance")
                         ? read_spectrum_key(reader, "radiance", SpectrumLimits::emission(), state)
                         : illuminant_with_luminance("D65", 1.0);
    const SourcePosition at = reader.position_of_key("file");
    light.image = load_image(reader.text("file"), at, ImageEncoding::Srgb, state);
    const Image& image = state.images[static_cast<std::size_t>(light.image)];
    for (const float value : image.rgb)
        if (value < 0.0f)
            throw_input_error({image.file.string()}, "the image holds negative radiance",
                              "clip it at 0");
    light.rotation_deg = reader.number_or("rotation_deg", 0.0, NumberRange::within(-1e6, 1e6));
    return light;
}

/// Names of groups part what `--groups` says and name layers of files.
std::string read_group(const TableReader& reader) {
    constexpr std::size_t longest = 40;
    const std::string name = reader.text_or("group", "");
    const bool is_right = std::all_of(name.begin(), name.end(), [](char c) {
        return c == '-' || c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
               (c >= 'A' && c <= 'Z');
    });
    if (reader.has("group") && (name.empty() || name.size() > longest || !is_right))
        reader.fail("group", "the name of a group is not made of 1 to 40 letters, digits, - and _",
                    "name it like \"window\" or \"uv-lamp\"");
    return name;
}

} // namespace

std::vector<Light> read_lights(const toml::table& table, const std::string& file, std::size_t index,
                               LoadState& state, std::string& group) {
    const std::string name = fmt::format("[[light]] {}", index);
    const std::string type = type_of_table(table, file, name,
                                           {"rectangle", "sphere", "disk", "mesh", "point", "spot",
                                            "directional", "environment", "sky"});
    const auto keys = [&](std::vector<std::string> own) {
        own.insert(own.begin(), {"type", "group"});
        const TableReader reader(table, file, fmt::format("{} ({})", name, type), own);
        group = read_group(reader);
        return reader;
    };
    if (type == "rectangle")
        return {read_rectangle_light(
            keys({"center", "edge_u", "edge_v", "target", "size", "radiance"}), state)};
    if (type == "sphere")
        return {read_sphere_light(keys({"center", "radius", "radiance"}), state)};
    if (type == "disk")
        return {read_disk_light(keys({"center", "normal", "target", "radius", "radiance"}), state)};
    if (type == "mesh")
        return {read_mesh_light(
            keys({"file", "transform", "scale", "rotate_deg", "translate", "radiance"}), state)};
    if (type == "directional")
        return {read_directional_light(keys({"direction", "angle_deg", "irradiance"}), state)};
    if (type == "environment")
        return {read_environment_light(keys({"radiance", "file", "rotation_deg"}), state)};
    if (type == "sky")
        return read_sky(keys(sky_keys()), state);
    if (type == "spot")
        return {read_spot_light(
            keys({"position", "direction", "target", "cone_deg", "falloff_deg", "intensity"}),
            state)};
    const TableReader reader = keys({"position", "intensity"});
    const Vector3 position = reader.vector("position");
    return {PointLight{position,
                       read_spectrum_key(reader, "intensity", SpectrumLimits::emission(), state)}};
}

} // namespace reradiant
