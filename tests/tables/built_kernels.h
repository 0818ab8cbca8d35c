#pragma once

#include "reradiant/render.h"

#include <cstddef>

namespace reradiant {

/// The size of the kernels of a scene, and the seconds that it took to build them from nothing.
struct BuiltKernels {
    double seconds = 0.0;
    std::size_t source_bytes = 0, instructions = 0, device_bytes = 0;
};

/// Renders a scene in a child process with empty caches; the driver of a process that has built a
/// program before would not build it again. To be called before this process uses OpenCL, which
/// does not survive a fork. Run-time Error when the child fails.
BuiltKernels kernels_built_anew(const Scene& scene, const RenderOptions& options);

} // namespace reradiant
