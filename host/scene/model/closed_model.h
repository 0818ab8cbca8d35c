#pragma once

#include "host/layers/models/stack_bsdf.h"
#include "reradiant/scene.h"

namespace reradiant {

/// Returns what makes a closed model of a stack, Adding or WeidlichWilkie; Input Error for others.
ClosedModel closed_model(Model model);

/// Returns a material's stack with its substrate, or a sheet down to its lower face, at a
/// wavelength.
StackElements material_at(const Material& material, double wavelength_nm);

} // namespace reradiant
