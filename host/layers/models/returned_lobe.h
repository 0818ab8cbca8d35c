#pragma once

#include "host/layers/rough/specular_lobes.h"
#include "reradiant/stack_elements.h"

#include <span>

namespace reradiant {

/// Returns the lobe of the light that comes back from a stack, unscattered in its slabs, and whose
/// deepest interface is one of elements `first` to `last` of it: the lobe of ggx facets over the
/// half vector in air, as wide as the interfaces spread light (kernels/scatter/lobe_width.h), times
/// a tabulated ratio. `first` lies beneath a rough interface or is rough itself; from it on all up
/// to `last` are smooth. Thread-safe.
///
/// What Blinn's cavities give back of the light that they lose is met by few walks. Where the lobe
/// is spread by cavities alone, above smooth interfaces, it has their distribution and no table.
///
/// Ratios (host/layers/models/lobe_ratios.h) are made by walks, without absorption, down to `last`
/// and back through the uppermost rough interface, which is connected to all directions whenever
/// light meets it; the lobe is the sum of those for both orders of its directions. Who uses it
/// scales it to the flux that it must carry.
LobeShape returned_lobe(std::span<const StackElement> stack, std::size_t first, std::size_t last);

/// Returns true where that lobe has a table.
bool has_returned_ratio(std::span<const StackElement> stack, std::size_t first, std::size_t last);

} // namespace reradiant
