#include "host/scene/toml/scene_parts.h"

#include "host/scene/images/image_io.h"
#include "host/scene/toml/spectrum_reader.h"
#include "reradiant/colour.h"

#include <fmt/core.h>

#include <algorithm>

namespace reradiant {

namespace {

Light read_rectangle_light(const TableReader& reader, LoadState& state) {
    RectangleLight light;
    light.centre = reader.vector("center");
    const auto edges = read_edges(reader);
    light.edge_u = edges[0];
    light.edge_v = edges[1];
    light.radiance = read_spectrum_key(reader, "radiance", SpectrumLimits::emission(), state);
    return light;
}

Light read_sphere_light(const TableReader& reader, LoadState& state) {
    SphereLight light;
    light.centre = reader.vector("center");
    light.radius =
        reader.number("radius", {.low = 0.0, .high = MAX_COORDINATE, .low_is_allowed = false});
    light.radiance = read_spectrum_key(reader, "radiance", SpectrumLimits::emission(), state);
    return light;
}

Light read_directional_light(const TableReader& reader, LoadState& state) {
    DirectionalLight light;
    light.direction = reader.vector("direction");
    if (!(vector_length(light.direction) > 0.0))
        reader.fail("direction", "direction is zero", "give the way that the light travels");
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

Light read_light(const toml::table& table, const std::string& file, std::size_t index,
                 LoadState& state, std::string& group) {
    const std::string name = fmt::format("[[light]] {}", index);
    const std::string type = type_of_table(
        table, file, name, {"rectangle", "sphere", "point", "directional", "environment"});
    const auto keys = [&](std::vector<std::string> own) {
        own.insert(own.begin(), {"type", "group"});
        const TableReader reader(table, file, fmt::format("{} ({})", name, type), own);
        group = read_group(reader);
        return reader;
    };
    if (type == "rectangle")
        return read_rectangle_light(keys({"center", "edge_u", "edge_v", "radiance"}), state);
    if (type == "sphere")
        return read_sphere_light(keys({"center", "radius", "radiance"}), state);
    if (type == "directional")
        return read_directional_light(keys({"direction", "irradiance"}), state);
    if (type == "environment")
        return read_environment_light(keys({"radiance", "file", "rotation_deg"}), state);
    const TableReader reader = keys({"position", "intensity"});
    const Vector3 position = reader.vector("position");
    return PointLight{position,
                      read_spectrum_key(reader, "intensity", SpectrumLimits::emission(), state)};
}

} // namespace reradiant
