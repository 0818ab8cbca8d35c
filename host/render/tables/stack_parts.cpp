#include "host/render/tables/stack_parts.h"

#include "host/layers/rough/facet_reflectance.h"

#include <algorithm>

namespace reradiant {

std::vector<StackPart> stack_parts(const Material& material) {
    std::vector<StackPart> parts;
    const std::vector<Layer>& layers = material.stack.layers;
    const auto append = [&](StackPart::Kind kind, std::size_t layer, const auto& surface) {
        parts.push_back({kind, layer, surface.distribution, surface.alpha});
    };
    for (std::size_t k = 0; k < layers.size(); ++k) {
        append(StackPart::Kind::Interface, k, layers[k]);
        if (layers[k].flakes && layers[k].flakes->coverage > 0.0)
            append(StackPart::Kind::Flakes, k, layers[k].flakes->reflector);
    }
    if (material.substrate.type == SubstrateType::Conductor)
        append(StackPart::Kind::Conductor, layers.size(), material.substrate.conductor);
    return parts;
}

std::vector<DeeperLobe> weidlich_wilkie_lobes(const Material& material) {
    std::vector<DeeperLobe> lobes;
    const std::vector<StackPart> parts = stack_parts(material);
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (p > 0 && parts[p].alpha > 0.0)
            lobes.push_back({false, p, parts[p].slabs_above()});
        // what the slab beneath an interface scatters, above the flakes at its lower end
        if (parts[p].kind == StackPart::Kind::Interface &&
            material.stack.layers[parts[p].layer].scatters())
            lobes.push_back({true, p + 1, parts[p].layer});
    }
    return lobes;
}

bool is_all_smooth(const Material& material) {
    const std::vector<StackPart> parts = stack_parts(material);
    return !material.stack.scatters() &&
           std::all_of(parts.begin(), parts.end(),
                       [](const StackPart& part) { return part.alpha == 0.0; });
}

double MaterialValues::facet_reflectance(const StackPart& part, double cos_theta) const {
    const double ior_above = ior_below(part.slabs_above());
    switch (part.kind) {
    case StackPart::Kind::Interface:
        return reradiant::facet_reflectance(stack[part.layer], ior_above, cos_theta);
    case StackPart::Kind::Flakes:
        return reradiant::facet_reflectance(stack[part.layer].flakes, ior_above, cos_theta);
    case StackPart::Kind::Conductor:
        break;
    }
    return reradiant::facet_reflectance(conductor, ior_above, cos_theta);
}

MaterialValues material_at(const Material& material, double wavelength_nm) {
    MaterialValues values{stack_at(material.stack, wavelength_nm), {}};
    if (material.substrate.type == SubstrateType::Conductor)
        values.conductor = conductor_at(material.substrate.conductor, wavelength_nm);
    return values;
}

} // namespace reradiant
