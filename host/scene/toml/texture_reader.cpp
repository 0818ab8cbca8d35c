#include "host/scene/model/textured_value.h"

#include "host/scene/images/image_io.h"

#include <algorithm>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr int MAX_LEVELS = 512;
constexpr int MAX_OCTAVES = 16;

void read_image_keys(const TableReader& reader, Texture& texture, LoadState& state) {
    texture.is_normal_map = reader.flag_or("normal_map", false);
    const bool linear = reader.flag_or("linear", false) || texture.is_normal_map;
    texture.image = load_image(reader.text("file"), reader.position_of_key("file"),
                               linear ? ImageEncoding::Linear : ImageEncoding::Srgb, state);
}

} // namespace

Texture read_texture(const toml::table& table, const std::string& file, std::size_t index,
                     LoadState& state) {
    const std::string name = fmt::format("[[texture]] {}", index);
    const std::string type =
        type_of_table(table, file, name, {"noise", "voronoi", "checker", "image"});
    std::vector<std::string> keys{"name", "type", "space", "size", "levels", "low", "high"};
    if (type == "noise")
        keys.insert(keys.end(), {"seed", "tilt_deg", "octaves", "sharpness"});
    if (type == "voronoi")
        keys.insert(keys.end(), {"seed", "tilt_deg", "share"});
    if (type == "image")
        keys.insert(keys.end(), {"file", "normal_map", "linear"});
    const TableReader reader(table, file, fmt::format("{} ({})", name, type), keys);
    // what they hold is read where the texture is used
    reader.describe("low", "number or SPECTRUM", "0");
    reader.describe("high", "number or SPECTRUM", "1");
    Texture texture;
    texture.name = reader.text("name");
    texture.type = type == "noise"     ? TextureType::Noise
                   : type == "voronoi" ? TextureType::Voronoi
                   : type == "checker" ? TextureType::Checker
                                       : TextureType::Image;
    const bool is_image = texture.type == TextureType::Image;
    texture.space = is_image ? TextureSpace::Uv : TextureSpace::World;
    if (reader.has("space"))
        texture.space = reader.choice("space", {"world", "uv"}) == "uv" ? TextureSpace::Uv
                                                                        : TextureSpace::World;
    texture.size = reader.number_or("size", is_image ? 1.0 : texture.size,
                                    {.low = 1e-9, .high = MAX_COORDINATE});
    const auto known = [&](const char* key) {
        return std::find(keys.begin(), keys.end(), key) != keys.end() && reader.has(key);
    };
    if (known("share"))
        texture.share = reader.number("share", NumberRange::between(0.0, 1.0));
    const bool is_binary = texture.type == TextureType::Checker || texture.share > 0.0;
    texture.levels = reader.integer_or("levels", is_binary ? 2 : texture.levels, 2, MAX_LEVELS);
    if (known("seed"))
        texture.seed = static_cast<unsigned>(reader.integer("seed", 0, 0x7fffffff));
    if (known("tilt_deg"))
        texture.tilt_deg = reader.number("tilt_deg", NumberRange::within(0.0, 60.0));
    if (known("octaves"))
        texture.octaves = reader.integer("octaves", 1, MAX_OCTAVES);
    if (known("sharpness"))
        texture.sharpness = reader.number("sharpness", NumberRange::within(0.0, 1000.0));
    if (is_image)
        read_image_keys(reader, texture, state);
    return texture;
}

} // namespace reradiant
