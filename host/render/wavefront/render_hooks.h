#pragma once

#include "kernels/core/shared.h"

#include <chrono>
#include <functional>
#include <optional>
#include <span>

namespace reradiant {

/// Sees every batch of rays before it is traced: what the tracing alone costs can be measured.
using RaySink = std::function<void(std::span<const RayRecord> rays, bool shadow, bool coherent)>;

/// Functions that a render calls on its way.
struct RenderHooks {
    RaySink on_rays = {};                 ///< may be empty
    std::function<void()> on_set_up = {}; ///< tables and kernels are ready; may be empty
    /// RenderOptions::time_seconds counts from here; none: from where rendering begins, and without
    /// what observers take.
    std::optional<std::chrono::steady_clock::time_point> time_counts_from = {};
};

} // namespace reradiant
