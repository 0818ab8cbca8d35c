#pragma once

#include "host/layers/walk/walk_estimate.h"

#include <functional>
#include <vector>

namespace reradiant {

/// Lets a measurement by the walk go on from where an earlier one with the same request stopped.
struct WalkContinuation {
    /// One state for every theta_i that the earlier call began.
    std::vector<WalkState> states;
    /// Called between walks with a function that returns the states so far; may be empty.
    std::function<void(const std::function<std::vector<WalkState>()>& states)> pause;
};

} // namespace reradiant
