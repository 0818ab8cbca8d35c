#pragma once

#include "host/device/buffer.h"
#include "host/render/plan/render_plan.h"
#include "host/render/tables/scene_tables.h"

#include <vector>

namespace reradiant {

/// The arrays of a render on its device but for the film's, as its plan foresees them.
struct WavefrontBuffers {
    WavefrontBuffers() = default;
    /// Allocates all and fills those that hold the scene. Run-time Error when the device has not
    /// the memory.
    WavefrontBuffers(const Device& device, const RenderPlan& plan, const SceneTables& scene);

    std::size_t bytes() const;

#define BUFFER(type, name) DeviceArray<type> name;
    RENDER_BUFFERS(BUFFER)
#undef BUFFER
    std::vector<DeviceArray<LightRecord>> layer_lights; ///< as in SceneTables
};

} // namespace reradiant
