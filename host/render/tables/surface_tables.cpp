#include "host/render/tables/scene_tables.h"

#include "host/scene/model/texture_record.h"

namespace reradiant {

namespace {

std::uint32_t index_or_none(int index) {
    return index < 0 ? NO_INDEX : static_cast<std::uint32_t>(index);
}

SurfaceRecord surface_record(const Surface& surface) {
    SurfaceRecord record{};
    record.first_material = static_cast<std::uint32_t>(surface.first_material);
    record.texture_count = static_cast<std::uint32_t>(surface.textures.size());
    for (std::size_t i = 0; i < surface.textures.size(); ++i)
        record.textures[i] = static_cast<std::uint32_t>(surface.textures.at(i));
    record.normal_texture = index_or_none(surface.normal_texture);
    record.mixed_with = index_or_none(surface.mixed_with);
    record.mix_weight = static_cast<float>(surface.mix_weight);
    record.mix_texture = index_or_none(surface.mix_texture);
    return record;
}

} // namespace

void append_surfaces(const Scene& scene, SceneTables& tables) {
    std::vector<std::uint32_t> image_offsets(scene.images.size(), NO_INDEX);
    for (const Texture& texture : scene.textures) {
        if (texture.image < 0)
            continue;
        std::uint32_t& offset = image_offsets[static_cast<std::size_t>(texture.image)];
        if (offset != NO_INDEX)
            continue;
        offset = static_cast<std::uint32_t>(tables.tables.size());
        const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
        tables.tables.insert(tables.tables.end(), image.rgb.begin(), image.rgb.end());
    }
    for (const Texture& texture : scene.textures) {
        tables.textures.push_back(texture_record(texture));
        if (const auto image = static_cast<std::size_t>(texture.image); texture.image >= 0)
            set_image(scene.images[image], image_offsets[image], tables.textures.back());
    }
    for (const Surface& surface : scene.surfaces)
        tables.surfaces.push_back(surface_record(surface));
    // scenes made by hand may leave the surfaces out: material i then is surface i
    for (std::size_t i = tables.surfaces.size();
         scene.surfaces.empty() && i < scene.materials.size(); ++i)
        tables.surfaces.push_back(
            {static_cast<std::uint32_t>(i), 0, {}, NO_INDEX, NO_INDEX, 0.0f, NO_INDEX});
}

} // namespace reradiant
