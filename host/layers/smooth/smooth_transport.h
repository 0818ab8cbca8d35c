#pragma once

#include "reradiant/adding.h"

#include <memory>

namespace reradiant {

/// AddingTransport of a stack without any rough interface (possibly without any interface), in
/// closed form at every direction.
std::shared_ptr<const AddingTransport> smooth_transport(const StackValues& stack);

} // namespace reradiant
