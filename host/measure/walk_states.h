#pragma once

#include "host/layers/walk/walk_estimate.h"

#include <nlohmann/json.hpp>

#include <vector>

namespace reradiant {

/// States of walks as a list of [blocks, walks, numbers], for checkpoints.
nlohmann::json walk_states_json(const std::vector<WalkState>& states);
/// Input Error for what is none or holds numbers that are not finite. Whether a state is of the
/// walk that is to go on, estimate_walk sees.
std::vector<WalkState> walk_states_from(const nlohmann::json& list);

} // namespace reradiant
