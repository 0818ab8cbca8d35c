#pragma once

#include "reradiant/stack_elements.h"

#include <span>

namespace reradiant {

/// Returns the stack with scattering counted as absorption: the light that is left was not
/// scattered by slabs.
StackElements without_scattered(std::span<const StackElement> stack);

/// Returns a sheet as it is seen from below: its elements in reverse order, interfaces turned
/// around.
StackElements upside_down(std::span<const StackElement> sheet);

/// True for an interface that spreads light.
bool is_rough_interface(const StackElement& element);

} // namespace reradiant
