#pragma once

#include "host/layers/walk/walk.h"
#include "reradiant/interruption.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace reradiant {

/// Means over many walks and their standard errors, entry by entry.
struct WalkEstimate {
    WalkTally mean, standard_error;
};

/// Walks are run in blocks, whose means give the standard errors (to 4 %).
inline constexpr std::uint64_t walk_blocks = 256;

/// A `WalkState` tells exactly how far an estimate has come: the blocks that every group of them
/// has done, the walks of the next block, and what they add up to. It holds numbers alone, so that
/// it can be kept in a file.
struct WalkState {
    std::uint64_t blocks = 0, walks = 0;
    std::vector<double> numbers; ///< empty: nothing was done
};

/// A `WalkPause` is called between walks, a few times a second, and when all are done. `state`
/// returns how far they are and is expensive to call.
using WalkPause = std::function<void(bool is_done, const std::function<WalkState()>& state)>;

/// Estimates what LayerWalk::eval means from `samples` walks, rounded up to full blocks. Parallel;
/// the same for a seed whatever the number of threads, and whether it is done at once or goes on
/// from the state that an earlier call with the same arguments told. Interrupted when `stop` is set
/// meanwhile. Run-time Error for the state of another estimate.
WalkEstimate estimate_walk(const LayerWalk& walk, const kernels::Vec3& wi,
                           std::span<const kernels::Vec3> wo, std::uint64_t samples,
                           std::uint64_t seed, StopFlag stop = nullptr, const WalkState& from = {},
                           const WalkPause& pause = {});

} // namespace reradiant
