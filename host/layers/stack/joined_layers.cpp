#include "host/layers/stack/joined_layers.h"

#include "host/spectral/spectrum/same_spectrum.h"
#include "reradiant/reradiation.h"

#include <algorithm>

namespace reradiant {

namespace {

bool has_flakes(const Layer& layer) {
    return layer.flakes && layer.flakes->coverage != 0.0;
}

/// True for a slab in which nothing happens to light.
bool is_empty(const Layer& layer) {
    return layer.thickness == 0.0 || (layer.absorption.is_zero() && !layer.scatters() &&
                                      std::ranges::none_of(layer.dyes, &SlabDye::absorbs));
}

std::vector<const SlabDye*> absorbing_dyes(const Layer& layer) {
    std::vector<const SlabDye*> dyes;
    for (const SlabDye& dye : layer.dyes)
        if (dye.absorbs())
            dyes.push_back(&dye);
    return dyes;
}

bool same_shares(const SlabDye& a, const SlabDye& b) {
    if (!a.shares || !b.shares)
        return !a.shares && !b.shares && a.quantum_yield == b.quantum_yield &&
               same_spectrum(a.emission, b.emission);
    return a.shares == b.shares ||
           (a.shares->emission == b.shares->emission &&
            a.shares->excitation == b.shares->excitation && a.shares->values == b.shares->values);
}

/// True when both hold the same dyes, whatever their concentrations.
bool same_dyes(const std::vector<const SlabDye*>& a, const std::vector<const SlabDye*>& b) {
    return std::ranges::equal(a, b, [](const SlabDye* one, const SlabDye* other) {
        return same_spectrum(one->absorption, other->absorption) && same_shares(*one, *other);
    });
}

/// Returns how much of `above` a unit of thickness of `below` stands for; 0 where the two differ in
/// more than the concentration of all.
double proportion(const Layer& above, const Layer& below) {
    if (!same_spectrum(above.absorption, below.absorption) ||
        !same_spectrum(above.scattering_coefficient, below.scattering_coefficient) ||
        (above.scatters() && above.anisotropy != below.anisotropy))
        return 0.0;
    const std::vector<const SlabDye*> dyes = absorbing_dyes(above), others = absorbing_dyes(below);
    if (!same_dyes(dyes, others))
        return 0.0;
    const bool dyes_are_all = above.absorption.is_zero() && !above.scatters();
    const double first = dyes.empty() ? 1.0 : dyes.front()->concentration;
    const double other_first = dyes.empty() ? 1.0 : others.front()->concentration;
    for (std::size_t k = 0; k < dyes.size(); ++k)
        if (others[k]->concentration * first != dyes[k]->concentration * other_first)
            return 0.0;
    return first == other_first ? 1.0 : dyes_are_all ? other_first / first : 0.0;
}

/// True when light goes from one medium to the other as if there were nothing between them.
bool is_no_interface(const Spectrum& ior_above, const Layer& below) {
    return !below.film && same_spectrum(ior_above, below.ior);
}

bool can_join(const Layer& above, const Layer& below) {
    return is_no_interface(above.ior, below) && !has_flakes(above) &&
           (is_empty(above) || is_empty(below) || proportion(above, below) > 0.0);
}

/// The two as one slab under the interface of the upper one.
Layer joined(const Layer& above, const Layer& below) {
    const bool takes_lower = is_empty(above);
    Layer both = takes_lower ? below : above;
    if (!takes_lower && !is_empty(below))
        both.thickness += proportion(above, below) * below.thickness;
    both.distribution = above.distribution;
    both.alpha = above.alpha;
    both.scattering = above.scattering;
    both.film = above.film;
    both.flakes = below.flakes;
    return both;
}

/// True when `holds(stack)` is true of all.
template <typename Holds>
bool in_all(const std::vector<LayerStack*>& stacks, const Holds& holds) {
    return std::ranges::all_of(stacks, [&](const LayerStack* stack) { return holds(*stack); });
}

const Spectrum& ior_above(const LayerStack& stack, std::size_t layer) {
    static const Spectrum air = Spectrum::constant(1.0);
    return layer == 0 ? air : stack.layers[layer - 1].ior;
}

void smooth_what_does_nothing(const std::vector<LayerStack*>& stacks, std::size_t layers) {
    for (std::size_t k = 0; k < layers; ++k)
        if (in_all(stacks, [&](const LayerStack& stack) {
                return is_no_interface(ior_above(stack, k), stack.layers[k]);
            }))
            for (LayerStack* stack : stacks)
                stack->layers[k].alpha = 0.0;
    if (in_all(stacks, [](const LayerStack& stack) {
            return stack.lower_face && !stack.layers.empty() &&
                   same_spectrum(stack.layers.back().ior, Spectrum::constant(1.0));
        }))
        for (LayerStack* stack : stacks)
            stack->lower_face->alpha = 0.0;
}

} // namespace

std::size_t join_layers(const std::vector<LayerStack*>& stacks) {
    if (stacks.empty())
        return 0;
    const std::size_t layers = stacks.front()->layers.size();
    smooth_what_does_nothing(stacks, layers);
    std::size_t kept = std::min<std::size_t>(layers, 1);
    for (std::size_t k = 1; k < layers; ++k) {
        const bool can = in_all(stacks, [&](const LayerStack& stack) {
            return can_join(stack.layers[kept - 1], stack.layers[k]);
        });
        for (LayerStack* stack : stacks) {
            if (can)
                stack->layers[kept - 1] = joined(stack->layers[kept - 1], stack->layers[k]);
            else if (kept != k)
                stack->layers[kept] = std::move(stack->layers[k]);
        }
        kept += can ? 0 : 1;
    }
    for (LayerStack* stack : stacks)
        stack->layers.resize(kept);
    return layers - kept;
}

} // namespace reradiant
