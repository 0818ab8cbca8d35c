#pragma once

#include "host/layers/models/adding.h"

#include <memory>
#include <span>

namespace reradiant {

/// Adding in a stack in which something scatters: a rough interface or a slab. Light that slabs
/// send back has the directions of the residual; its energy is exact.
std::shared_ptr<const AddingModel> angular_transport(std::span<const StackElement> stack);

} // namespace reradiant
