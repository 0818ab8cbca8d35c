#include "host/scene/model/texture_record.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

std::uint32_t kernel_type(TextureType type) {
    switch (type) {
    case TextureType::Noise:
        return TEXTURE_NOISE;
    case TextureType::Voronoi:
        return TEXTURE_VORONOI;
    case TextureType::Checker:
        return TEXTURE_CHECKER;
    case TextureType::Image:
        break;
    }
    return TEXTURE_IMAGE;
}

} // namespace

TextureRecord texture_record(const Texture& texture) {
    TextureRecord record{};
    record.type = kernel_type(texture.type);
    record.space = texture.space == TextureSpace::World ? TEXTURE_WORLD : TEXTURE_UV;
    record.inverse_size = static_cast<float>(1.0 / texture.size);
    record.octaves = static_cast<std::uint32_t>(texture.octaves);
    record.tilt = static_cast<float>(std::tan(texture.tilt_deg * std::numbers::pi / 180.0));
    record.sharpness = static_cast<float>(texture.sharpness);
    record.share = static_cast<float>(texture.share);
    record.is_normal_map = texture.is_normal_map ? 1u : 0u;
    record.levels = static_cast<std::uint32_t>(std::max(texture.levels, 2));
    record.seed = texture.seed;
    return record;
}

void set_image(const Image& image, std::uint32_t offset, TextureRecord& record) {
    record.image = offset;
    record.width = static_cast<std::uint32_t>(image.width);
    record.height = static_cast<std::uint32_t>(image.height);
}

} // namespace reradiant
