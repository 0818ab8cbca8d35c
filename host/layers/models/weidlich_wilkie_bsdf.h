#pragma once

#include "host/layers/models/stack_bsdf.h"

#include <cstddef>
#include <vector>

namespace reradiant {

/// Model A, Weidlich and Wilkie 2007, for any stack. Albedos are integrated numerically, to about
/// 1e-5 of the incident light (1e-4 with blinn, whose G has kinks).
///
/// Where something is rough or a slab scatters, Fresnel and geometry factors depend on both
/// directions and are applied by the kernel (kernels/stack/layer_stack.h); transmission and
/// amplitudes then hold absorption and the passage through films alone.
std::shared_ptr<const StackBsdf> weidlich_wilkie_bsdf(const StackElements& stack);

/// A lobe beneath the top one: of a rough surface, or what a slab scatters.
struct DeeperLobe {
    std::size_t element = 0;
    std::size_t part = 0; ///< surfaces, flakes and conductors above the element
};
/// Returns the deeper lobes of a stack, which are the same at every wavelength.
std::vector<DeeperLobe> weidlich_wilkie_lobes(const StackElements& stack);

/// Returns true when every surface is smooth and no slab scatters at any wavelength, so that
/// functions of one cosine are the whole model.
bool is_all_smooth(const StackElements& stack);

} // namespace reradiant
