#pragma once

#include "host/layers/models/stack_bsdf.h"
#include "host/layers/stack/side.h"
#include "reradiant/scene.h"

namespace reradiant {

/// Returns what makes a closed model of a stack, Adding or WeidlichWilkie; Input Error for others.
ClosedModel closed_model(Model model);

/// Returns a material's stack with its substrate, or a sheet down to its lower face, at a
/// wavelength. A sheet may be seen from below.
StackElements material_at(const Material& material, double wavelength_nm, Side from = Side::Above);

} // namespace reradiant
