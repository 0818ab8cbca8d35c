#pragma once

#include "reradiant/render.h"

namespace reradiant {

/// Input Error when a render would take more memory than it may.
void check_render_memory(const Scene& scene, const WavelengthPlan& plan,
                         const RenderOptions& options);

} // namespace reradiant
