#pragma once

#include "reradiant/layer_stack.h"

namespace reradiant {

/// Throws an input Error that names the layer for numbers out of physical range: every model calls
/// this first.
void check_stack(const StackValues& stack);

/// Throws an input Error for a conductor substrate whose numbers are out of physical range.
void check_conductor(const ConductorValues& conductor);

} // namespace reradiant
