#pragma once

#include "host/layers/rough/specular_lobes.h"
#include "reradiant/stack_elements.h"

namespace reradiant {

/// Returns the share of the light from cos_theta (in the medium above) that a rough surface sends
/// back after more than one event at its facets, for the scattering `multiple`; it is zero for
/// smooth surfaces and for `single`.
///
/// An interface sends back what its operator reflects (interface_operator.h, from either side)
/// beyond the lobe F D G / (4 ci co), and nothing where the media are alike. One that bears a film
/// has no operator (it would need one for each wavelength) and counts as a mirror of its facets'
/// reflectance, like a conductor. These facets count at their cosine-weighted mean reflectance at
/// every meeting: over the orders of a walk between them (facet_orders.h), or, for blinn, whose
/// V-cavities have no walk, after Kulla and Conty 2017. Everything is sent back where facets
/// reflect all.
CosineTable facet_interreflection(const SurfaceValues& surface);

} // namespace reradiant
