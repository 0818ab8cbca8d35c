#pragma once

#include "reradiant/stack_elements.h"

namespace reradiant {

/// Throws an input Error that names the layer, or the conductor at the end, for numbers out of
/// physical range: every model calls this first.
void check_stack(std::span<const StackElement> stack);

} // namespace reradiant
