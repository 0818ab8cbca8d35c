#pragma once

#include "reradiant/adding.h"

#include <memory>

namespace reradiant {

/// AddingTransport of a stack in which something scatters: a rough interface or a slab. Light that
/// slabs send back has the directions of the residual; its energy is exact.
std::shared_ptr<const AddingTransport> angular_transport(const StackValues& stack);

} // namespace reradiant
