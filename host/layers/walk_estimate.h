#pragma once

#include "host/interruption.h"
#include "host/layers/walk.h"

namespace reradiant {

/// Means over many walks and their standard errors, entry by entry.
struct WalkEstimate {
    WalkTally mean, standard_error;
};

/// Walks are run in blocks, whose means give the standard errors (to 4 %).
inline constexpr std::uint64_t walk_blocks = 256;

/// Estimates what LayerWalk::eval means from `samples` walks, rounded up to full blocks. Parallel;
/// the same for a seed whatever the number of threads. Interrupted when `stop` is set meanwhile.
WalkEstimate estimate_walk(const LayerWalk& walk, const kernels::Vec3& wi,
                           std::span<const kernels::Vec3> wo, std::uint64_t samples,
                           std::uint64_t seed, StopFlag stop = nullptr);

} // namespace reradiant
