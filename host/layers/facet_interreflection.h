#pragma once

#include "host/layers/specular_lobes.h"
#include "host/layers/stack.h"

namespace reradiant {

/// Share of the light from cos_theta (in the medium above) that a rough interface sends back after
/// more than one event at its facets, `multiple`: what its operator reflects (interface_operator.h,
/// from either side) beyond the lobe F D G / (4 ci co). Zero for smooth interfaces, for `single`
/// and where the media are alike. An interface that bears a film has no operator (it would need one
/// a wavelength) and counts as a mirror of its facets' reflectance, like a conductor.
CosineTable facet_interreflection(const LayerValues& layer, double ior_above);

/// The same of a conductor: (1 - E(c)) Fm^2 Em / (1 - Fm (1 - Em)), E the albedo of the lobe
/// without Fresnel, Em and Fm the cosine-weighted means of E and of the reflectance. Everything is
/// sent back where the facets reflect everything (Kulla and Conty 2017, with both meetings after
/// the first counted at the mean reflectance).
CosineTable facet_interreflection(const ConductorValues& conductor, double ior_above);

} // namespace reradiant
