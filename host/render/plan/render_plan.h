#pragma once

#include "host/render/film/film_sums.h"
#include "host/render/plan/buffer_plan.h"
#include "host/render/plan/light_plan.h"
#include "host/render/plan/material_plan.h"
#include "host/render/plan/render_features.h"
#include "reradiant/render.h"

#include <cstdint>
#include <string>
#include <vector>

namespace reradiant {

/// A `RenderPlan` says what a render needs. It is made before anything is built or allocated and
/// does not change after; tables, kernels, wavefront, film and the check of memory read it.
struct RenderPlan {
    WavelengthPlan wavelengths;
    std::vector<MaterialPlan> materials; ///< as in Scene::materials
    /// By surface: the material of a smooth sheet that shadow rays pass, or NO_INDEX; empty where
    /// kernels know no such thing.
    std::vector<std::uint32_t> passed_sheets;
    LightPlan lights;
    RenderFeatures features;
    FilmLayout film; ///< of the image and of every layer

    std::uint64_t pixels = 0;
    std::uint32_t path_capacity = 0; ///< paths of a batch at most
    std::uint32_t depths = 0;        ///< vertices of a path at most, that on an emitter counted
    std::uint32_t max_depth = 0, min_depth = 0, seed = 0;
    std::uint32_t sequence_blocks = 0; ///< a path's first blocks, from the sequence (sequence.h)

    /// Exact but for the tables of rough interfaces that change no IOR, which come out smaller, and
    /// for walk_chunks, which may grow.
    BufferCounts counts;
    std::uint64_t host_bytes = 0; ///< the image and what it is made with, and a copy of the tables
    std::vector<std::string> notes; ///< the model of each material and why

    std::vector<BufferPlan> buffers() const { return needed_buffers(counts); }
    std::uint64_t films() const { return 1 + lights.layers.size(); }
    std::uint64_t device_bytes() const;
    /// A line for every feature that kernels lack and every wavelength that is not sampled.
    std::vector<std::string> left_out() const;
};

/// Plans a render. Input Error when it would take more memory than it may, for what a model cannot
/// do, and for --double on a device that has none.
RenderPlan plan_render(const Scene& scene, const DeviceInfo& device, const RenderOptions& options);

} // namespace reradiant
