#pragma once

#include "reradiant/layer_stack.h"

namespace reradiant {

/// Returns the reflectance (unit 1) of a facet of the interface on top of `layer` for unpolarised
/// light that comes from a medium of IOR `ior_above` at cos_theta >= 0: that of Fresnel, or the
/// coherent one where the interface bears a film.
double facet_reflectance(const LayerValues& layer, double ior_above, double cos_theta);

/// Returns the reflectance (unit 1) of a facet of a conductor (or a flake) in a medium of IOR
/// `ior_above`, for unpolarised light at cos_theta >= 0.
double facet_reflectance(const ConductorValues& conductor, double ior_above, double cos_theta);

} // namespace reradiant
