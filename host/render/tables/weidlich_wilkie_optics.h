#pragma once

#include "host/render/tables/stack_optics.h"

namespace reradiant {

/// Model A. Where something is rough or a slab scatters, Fresnel and geometry factors depend on
/// both directions and are applied by the kernel (layer_stack.h); the tables then hold absorption
/// and the passage through films alone.
std::unique_ptr<StackOptics> weidlich_wilkie_optics(const Material& material, double wavelength_nm);

} // namespace reradiant
