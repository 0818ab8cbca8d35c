#pragma once

#include "reradiant/layer_stack.h"

#include <cstddef>
#include <vector>

namespace reradiant {

/// Takes away what does nothing in a stack. Between media of one IOR there is no interface: its
/// roughness is set to 0, and where the slabs on both sides hold the same in the same proportions,
/// or one of them holds nothing, they become one slab as thick as both, so that every model gives
/// what it gives of that slab, to the bit. Films and flakes are kept, and what they lie between.
///
/// The stacks are those of one surface at the levels of its textures, with equally many layers:
/// they are joined only where all of them can be. Returns how many layers each has lost.
std::size_t join_layers(const std::vector<LayerStack*>& stacks);

} // namespace reradiant
