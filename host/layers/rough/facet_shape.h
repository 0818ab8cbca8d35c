#pragma once

#include "host/layers/rough/interface_walk.h"

#include <memory>
#include <vector>

namespace reradiant {

/// Returns where light goes that an interface sends back into the thinner medium after more than
/// one event at its facets: the table that kernels/scatter/facet_shape.h reads, over the lobe of
/// ggx facets of the same alpha (unit 1). It is null where there is no such light that has a shape
/// of its own: for `single`, and for blinn, whose V-cavities give it back in a product of two
/// cosines (host/layers/rough/lost_flux.h).
///
/// Its size goes with the facets' light of an interface nearby: tables are made for IOR ratios
/// rounded to 0.05 (0.01 below 1.1) and for widths rounded to a 16th part of an octave, kept in
/// memory and in the disk cache (cache_directory()/interfaces). Who uses one scales it to the flux
/// that it must carry. Thread-safe.
///
/// A node's value is the mean over walks on the Smith microsurface (Heitz, Hanika, d'Eon and
/// Dachsbacher 2016) that begin at the more grazing of its two directions, whose variance is less,
/// with every facet after the first connected to the other direction.
std::shared_ptr<const std::vector<float>> facet_shape(const RoughInterface& interface);

} // namespace reradiant
