#pragma once

#include "host/layers/rough/specular_lobes.h"
#include "reradiant/layer_stack.h"

namespace reradiant {

/// Returns the share of the light from cos_theta (in the medium above) that a rough interface sends
/// back after more than one event at its facets, for the scattering `multiple`: what its operator
/// reflects (interface_operator.h, from either side) beyond the lobe F D G / (4 ci co). It is zero
/// for smooth interfaces, for `single` and where the media are alike. An interface that bears a
/// film has no operator (it would need one for each wavelength) and counts as a mirror of its
/// facets' reflectance, like a conductor.
CosineTable facet_interreflection(const LayerValues& layer, double ior_above);

/// Returns the share that a conductor sends back after more than one event at its facets. The
/// facets count at their cosine-weighted mean reflectance at every meeting: over the orders of a
/// walk between them (facet_orders.h), or, for blinn, whose V-cavities have no walk, after Kulla
/// and Conty 2017. Everything is sent back where facets reflect all.
CosineTable facet_interreflection(const ConductorValues& conductor, double ior_above);

} // namespace reradiant
