#pragma once

#include "host/layers/sources/emitting_stack.h"

#include <string>
#include <vector>

namespace reradiant {

/// Returns a digest, 64 hex digits, of all that the operator of a dyed material depends on: its
/// stacks by phase, and the build of the program, which holds every constant and method.
std::string dyed_key(const std::vector<DyedStack>& by_phase);

} // namespace reradiant
