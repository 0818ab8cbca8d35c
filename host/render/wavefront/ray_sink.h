#pragma once

#include "kernels/core/shared.h"

#include <functional>
#include <span>

namespace reradiant {

/// Sees every batch of rays before it is traced: what the tracing alone costs can be measured.
using RaySink = std::function<void(std::span<const RayRecord> rays, bool shadow, bool coherent)>;

} // namespace reradiant
