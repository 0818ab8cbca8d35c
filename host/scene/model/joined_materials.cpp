#include "host/scene/model/joined_materials.h"

#include "host/base/logging.h"
#include "host/layers/stack/joined_layers.h"

#include <fmt/core.h>

namespace reradiant {

namespace {

void join_and_tell(const std::vector<Material*>& materials) {
    std::vector<LayerStack*> stacks;
    for (Material* material : materials)
        stacks.push_back(&material->stack);
    const std::size_t lost = join_layers(stacks);
    if (lost == 0)
        return;
    const Material& first = *materials.front();
    const std::size_t left = first.stack.layers.size();
    logging::debug("{}: neighbouring layers of \"{}\" are one medium: {} of {} are computed",
                   first.position.text(), first.name, left, left + lost);
}

/// Materials of a surface at the levels of its textures.
std::size_t variants_of(const Scene& scene, const Surface& surface) {
    std::size_t count = 1;
    for (const int texture : surface.textures)
        count *= static_cast<std::size_t>(scene.textures[static_cast<std::size_t>(texture)].levels);
    return count;
}

} // namespace

void join_layers(Material& material) {
    join_and_tell({&material});
}

void join_layers(Scene& scene) {
    for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
        const Surface& surface = scene.surfaces[k];
        const auto first = static_cast<std::size_t>(surface.first_material);
        std::vector<Material*> variants;
        for (std::size_t v = 0; v < variants_of(scene, surface); ++v)
            variants.push_back(&scene.materials.at(first + v));
        join_and_tell(variants);
        if (first != k) // the middle of the textures, which is measured
            join_layers({&scene.materials.at(k).stack});
    }
}

} // namespace reradiant
