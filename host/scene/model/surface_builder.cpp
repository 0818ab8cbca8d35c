#include "host/scene/model/surface_builder.h"

#include "reradiant/scene_file.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reradiant {

int SurfaceBuilder::mixed_with(std::size_t surface, const std::map<std::string, int>& names,
                               LoadState& state) {
    const std::string name = readings_[surface].mixed_with;
    const SourcePosition at = readings_[surface].mixed_with_position;
    if (name.empty())
        return -1;
    int other = -1;
    const auto presets = preset_names();
    if (const auto own = names.find(name); own != names.end()) {
        other = own->second;
    } else if (const auto preset = appended_presets_.find(name);
               preset != appended_presets_.end()) {
        other = preset->second;
    } else if (std::find(presets.begin(), presets.end(), name) != presets.end()) {
        readings_.push_back(read_preset(name, at, state));
        other = static_cast<int>(readings_.size()) - 1;
        appended_presets_.emplace(name, other);
    } else {
        std::vector<std::string> known_names;
        for (const auto& [known, ignored] : names)
            known_names.push_back(known);
        throw_input_error(at, fmt::format("no material is called \"{}\"", name),
                          fmt::format("there are {} and the presets {}",
                                      fmt::join(known_names, ", "), fmt::join(presets, ", ")));
    }
    return other;
}

/// Refuses a mixture that holds itself, at the first material that is in its own mixture.
void SurfaceBuilder::refuse_circles(const std::vector<int>& others) const {
    const auto name = [&](std::size_t i) { return readings_[i].representative.name; };
    for (std::size_t start = 0; start < others.size(); ++start) {
        std::string way = fmt::format("\"{}\"", name(start));
        std::size_t at = start;
        for (std::size_t step = 0; step < others.size() && others[at] >= 0; ++step) {
            at = static_cast<std::size_t>(others[at]);
            way += fmt::format(" with \"{}\"", name(at));
            if (at == start)
                throw_input_error(readings_[start].mixed_with_position,
                                  fmt::format("a material is mixed with itself: {}", way),
                                  "let the last of them be no mixture, or name another material");
        }
    }
}

void SurfaceBuilder::finish(const std::map<std::string, int>& names, Scene& scene,
                            LoadState& state) {
    std::vector<int> others;
    for (std::size_t i = 0; i < readings_.size(); ++i) // grows by presets, which mix with none
        others.push_back(mixed_with(i, names, state));
    refuse_circles(others);
    for (const MaterialReading& reading : readings_)
        scene.materials.push_back(reading.representative);
    for (std::size_t i = 0; i < readings_.size(); ++i) {
        const MaterialReading& reading = readings_[i];
        Surface surface;
        surface.name = reading.representative.name;
        surface.first_material = static_cast<int>(i);
        if (!reading.variants.empty()) {
            surface.first_material = static_cast<int>(scene.materials.size());
            scene.materials.insert(scene.materials.end(), reading.variants.begin(),
                                   reading.variants.end());
        }
        surface.textures = reading.textures;
        surface.normal_texture = reading.normal_texture;
        surface.mixed_with = others[i];
        surface.mix_weight = reading.mix_weight;
        surface.mix_texture = reading.mix_texture;
        surface.opacity = reading.opacity;
        surface.opacity_texture = reading.opacity_texture;
        scene.surfaces.push_back(std::move(surface));
    }
}

std::vector<Surface> plain_surfaces(const Scene& scene) {
    std::vector<Surface> surfaces;
    for (const Material& material : scene.materials) {
        Surface surface;
        surface.name = material.name;
        surface.first_material = static_cast<int>(surfaces.size());
        surfaces.push_back(std::move(surface));
    }
    return surfaces;
}

} // namespace reradiant
