#pragma once

#include "host/layers/adding.h"

#include <memory>

namespace reradiant {

/// AddingTransport of a stack with at least one rough interface.
std::shared_ptr<const AddingTransport> rough_transport(const StackValues& stack);

} // namespace reradiant
