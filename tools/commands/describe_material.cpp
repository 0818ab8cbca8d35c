#include "tools/commands/describe_material.h"

#include "host/scene/model/fluorescence_ranges.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

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

std::string range_text(const std::array<double, 2>& range_nm) {
    return range_nm[1] > 0.0 ? fmt::format("{} to {} nm", range_nm[0], range_nm[1]) : "nothing";
}

/// Returns the count of dyes in all layers, and what they absorb and emit; empty without dyes.
Json describe_dyes(const LayerStack& stack) {
    std::size_t count = 0;
    std::array<double, 2> absorbed{};
    for (const Layer& layer : stack.layers) {
        count += layer.dyes.size();
        for (const SlabDye& dye : layer.dyes) {
            const std::array<double, 2> own = support_nm(dye.absorption);
            if (layer.thickness > 0.0 && dye.absorbs() && own[1] > 0.0)
                absorbed = absorbed[1] > 0.0 ? std::array{std::min(absorbed[0], own[0]),
                                                          std::max(absorbed[1], own[1])}
                                             : own;
        }
    }
    if (count == 0)
        return {};
    return {{"count", count},
            {"absorb", range_text(absorbed)},
            {"emit", range_text(fluorescence_ranges(stack).emission)}};
}

std::string face_text(const LowerFace& face) {
    if (face.alpha == 0.0)
        return "smooth";
    constexpr std::array distributions{"blinn", "beckmann", "ggx"};
    return fmt::format("{}, alpha {:.6g}, {}",
                       distributions.at(static_cast<std::size_t>(face.distribution)), face.alpha,
                       face.scattering == Scattering::Multiple ? "multiple" : "single");
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
                   {"sheet", material.stack.is_sheet()},
                   {"fluorescent", material.is_fluorescent()}};
    if (material.stack.is_sheet())
        result["lower_face"] = face_text(*material.stack.lower_face);
    if (Json dyes = describe_dyes(material.stack); !dyes.empty())
        result["dyes"] = std::move(dyes);
    if (material.is_fluorescent()) {
        const FluorescenceRanges ranges = fluorescence_ranges(material);
        result["excited"] = range_text(ranges.excitation);
        result["emits"] = range_text(ranges.emission);
    }
    return result;
}

Json describe_surfaces(const Scene& scene) {
    const auto texture_name = [&](int texture) {
        return scene.textures[static_cast<std::size_t>(texture)].name;
    };
    Json surfaces = Json::array();
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        const Surface& surface = scene.surfaces[i];
        // A textured one has its middle in its own place: its first variant may hold no dye.
        Json entry = describe_material(scene.materials[i]);
        if (!surface.textures.empty())
            entry["variants"] = variant_count(scene, surface);
        for (const int texture : surface.textures)
            entry["textures"].push_back(texture_name(texture));
        if (surface.normal_texture >= 0)
            entry["normals"] = texture_name(surface.normal_texture);
        if (surface.mixed_with >= 0)
            entry["mixed_with"] = scene.surfaces[static_cast<std::size_t>(surface.mixed_with)].name;
        if (!surface.is_opaque())
            entry["opacity"] = surface.opacity_texture >= 0
                                   ? Json(texture_name(surface.opacity_texture))
                                   : Json(surface.opacity[0]);
        surfaces.push_back(std::move(entry));
    }
    return surfaces;
}

} // namespace reradiant
