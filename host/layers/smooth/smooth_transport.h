#pragma once

#include "host/layers/models/stack_bsdf.h"

#include <memory>
#include <span>

namespace reradiant {

/// Adding in a stack in which nothing scatters (possibly without any interface), in closed form at
/// every direction.
std::shared_ptr<const StackBsdf> smooth_transport(std::span<const StackElement> stack);

} // namespace reradiant
