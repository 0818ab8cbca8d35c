#pragma once

#include "reradiant/layer_stack.h"

namespace reradiant {

/// Reflectance (unit 1) of a facet of the interface on top of `layer` for unpolarised light that
/// comes from a medium of IOR `ior_above` at cos_theta >= 0: Fresnel, or coherent where it bears a
/// film.
double facet_reflectance(const LayerValues& layer, double ior_above, double cos_theta);

/// The same of a conductor (or a flake) in a medium of IOR `ior_above`.
double facet_reflectance(const ConductorValues& conductor, double ior_above, double cos_theta);

} // namespace reradiant
