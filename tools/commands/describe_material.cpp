#include "tools/commands/describe_material.h"

#include <fmt/core.h>

namespace reradiant {

namespace {

using Json = nlohmann::ordered_json;

const char* substrate_name(SubstrateType type) {
    switch (type) {
    case SubstrateType::OrenNayar:
        return "oren-nayar";
    case SubstrateType::Conductor:
        return "conductor";
    case SubstrateType::None:
        return "none";
    case SubstrateType::Lambert:
        break;
    }
    return "lambert";
}

/// Returns the count of materials of a surface: 1, or the product of its textures' levels.
int variant_count(const Scene& scene, const Surface& surface) {
    int count = 1;
    for (const int texture : surface.textures)
        count *= scene.textures[static_cast<std::size_t>(texture)].levels;
    return count;
}

} // namespace

Json describe_material(const Material& material) {
    const Substrate& substrate = material.substrate;
    Json result = {{"name", material.name},
                   {"model", model_name(material.model)},
                   {"layers", material.stack.layers.size()},
                   {"smooth", material.stack.is_smooth()},
                   {"absorbs", material.stack.absorbs()},
                   {"scatters", material.stack.scatters()},
                   {"films", material.stack.has_films() || substrate.conductor.film.has_value()},
                   {"flakes", material.stack.has_flakes()},
                   {"substrate", substrate_name(substrate.type)},
                   {"fluorescent", substrate.is_fluorescent()}};
    if (substrate.is_fluorescent()) {
        const auto excitation = substrate.excitation_range_nm();
        const auto emission = substrate.emission_range_nm();
        result["excited"] = fmt::format("{} to {} nm", excitation[0], excitation[1]);
        result["emits"] = fmt::format("{} to {} nm", emission[0], emission[1]);
    }
    return result;
}

Json describe_surfaces(const Scene& scene) {
    const auto texture_name = [&](int texture) {
        return scene.textures[static_cast<std::size_t>(texture)].name;
    };
    Json surfaces = Json::array();
    for (const Surface& surface : scene.surfaces) {
        Json entry =
            describe_material(scene.materials[static_cast<std::size_t>(surface.first_material)]);
        if (!surface.textures.empty())
            entry["variants"] = variant_count(scene, surface);
        for (const int texture : surface.textures)
            entry["textures"].push_back(texture_name(texture));
        if (surface.normal_texture >= 0)
            entry["normals"] = texture_name(surface.normal_texture);
        if (surface.mixed_with >= 0)
            entry["mixed_with"] = scene.surfaces[static_cast<std::size_t>(surface.mixed_with)].name;
        surfaces.push_back(std::move(entry));
    }
    return surfaces;
}

} // namespace reradiant
