#pragma once

#include "host/layers/models/adding.h"

#include <memory>
#include <span>

namespace reradiant {

/// Adding in a stack in which nothing scatters (possibly without any interface), in closed form at
/// every direction.
std::shared_ptr<const AddingModel> smooth_transport(std::span<const StackElement> stack);

} // namespace reradiant
