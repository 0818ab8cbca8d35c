#include "host/render/tables/stack_optics.h"

#include "host/layers/models/weidlich_wilkie_bsdf.h"
#include "host/scene/model/closed_model.h"
#include "kernels/core/shared.h"

#include <tbb/parallel_for.h>

namespace reradiant {

namespace {

/// Lobes besides the top one that adding makes at most: one of the light between the top's facets,
/// one for each deeper rough interface and for each run of smooth ones beneath a rough one.
int adding_lobe_count(const LayerStack& stack) {
    int count = has_facet_lobe(stack) ? 1 : 0;
    bool below_rough = false, in_run = false;
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        const bool rough = stack.layers[k].alpha > 0.0;
        if (k > 0 && (rough || (below_rough && !in_run)))
            ++count;
        below_rough = below_rough || rough;
        in_run = below_rough && !rough;
    }
    return count;
}

} // namespace

bool has_facet_lobe(const LayerStack& stack) {
    if (stack.layers.empty())
        return false;
    const Layer& top = stack.layers.front();
    return top.alpha > 0.0 && top.scattering == Scattering::Multiple &&
           top.distribution != Distribution::Blinn && top.ior(reference_nm) > 1.0;
}

bool depends_on_wavelength(const Material& material) {
    const Conductor& metal = material.substrate.conductor;
    return !material.stack.is_constant() ||
           (material.substrate.type == SubstrateType::Conductor &&
            !(metal.ior.is_constant() && metal.kappa.is_constant() && !metal.film));
}

int deeper_lobe_count(const Material& material, Model model) {
    if (model != Model::WeidlichWilkie)
        return adding_lobe_count(material.stack);
    return static_cast<int>(weidlich_wilkie_lobes(material_at(material, reference_nm)).size());
}

MaterialOptics::MaterialOptics(const Material& material, Model model, const WavelengthPlan& plan)
    : spectral_(depends_on_wavelength(material)), lanes_(static_cast<int>(plan.lanes.size())) {
    const int count = spectral_ ? plan.phases * lanes_ : 1;
    optics_.resize(static_cast<std::size_t>(count));
    tbb::parallel_for(0, count, [&](int i) {
        const double wavelength =
            spectral_ ? plan.wavelength_nm(i % lanes_, i / lanes_) : reference_nm;
        optics_[static_cast<std::size_t>(i)] =
            closed_model(model)(material_at(material, wavelength));
    });
}

} // namespace reradiant
