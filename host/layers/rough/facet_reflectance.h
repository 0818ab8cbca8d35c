#pragma once

#include "reradiant/stack_elements.h"

namespace reradiant {

/// Returns the reflectance (unit 1) of a facet of a surface for unpolarised light that comes from
/// above at cos_theta >= 0: that of Fresnel, or the coherent one where it bears a film.
double facet_reflectance(const SurfaceValues& surface, double cos_theta);

} // namespace reradiant
