#pragma once

#include "host/layers/walk/walk_estimate.h"

#include <nlohmann/json.hpp>

#include <vector>

namespace reradiant {

/// States of walks as a list of [blocks, walks, numbers], for checkpoints.
nlohmann::json walk_states_json(const std::vector<WalkState>& states);
/// Reads such a list. Input Error for other JSON and for numbers that are not finite. estimate_walk
/// checks that a state is of the walk that is to go on.
std::vector<WalkState> walk_states_from(const nlohmann::json& list);

} // namespace reradiant
