#pragma once

#include "reradiant/layer_stack.h"

namespace reradiant {

/// Input Error, naming the layer, for numbers out of physical range: every model asks first.
void check_stack(const StackValues& stack);

/// The same of a conductor substrate.
void check_conductor(const ConductorValues& conductor);

} // namespace reradiant
