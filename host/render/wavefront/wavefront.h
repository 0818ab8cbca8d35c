#pragma once

#include "host/device/opencl_device.h"
#include "host/device/program.h"
#include "host/geometry/geometry.h"
#include "host/render/film/device_film.h"
#include "host/render/plan/render_plan.h"
#include "host/render/tables/scene_tables.h"
#include "host/render/wavefront/render_hooks.h"
#include "host/render/wavefront/wavefront_buffers.h"
#include "reradiant/device.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace reradiant {

/// `WavefrontStatistics` says where the time went, in seconds, and how much work it was.
struct WavefrontStatistics {
    double intersect_seconds = 0.0, occlude_seconds = 0.0; ///< Embree, on the host
    double generate_seconds = 0.0, shade_seconds = 0.0, gather_seconds = 0.0,
           film_seconds = 0.0; ///< kernels
    std::uint64_t paths = 0;
    std::uint64_t rays = 0; ///< camera, path and shadow rays that were traced
    /// Rays and hits mapped for the host: what would cross the bus of a device with memory of its
    /// own.
    std::uint64_t mapped_bytes = 0;
};

/// The wavefront path tracer: stages on the device, rays on the host (kernels/README.md).
class Wavefront {
public:
    /// threads: that trace rays, 0 for all. on_rays may be empty.
    Wavefront(const Device& device, const Geometry& geometry, const RenderPlan& plan,
              const SceneTables& scene, int threads, const RaySink& on_rays,
              BuildStatistics& build);

    /// Adds samples [first_sample, first_sample + samples) of every pixel to the film.
    void render_pass(std::uint32_t first_sample, std::uint32_t samples);
    /// Adds so many samples of chosen pixels, which ascend. Needs RenderOptions::adaptive.
    void render_pass(std::span<const PixelSamples> pixels, std::uint32_t samples);

    /// The film of the image.
    DeviceFilm& film() { return films_.front(); }
    const DeviceFilm& film() const { return films_.front(); }
    /// That of the image, then one for each layer of the plan's lights.
    std::span<DeviceFilm> films() { return films_; }
    std::span<const DeviceFilm> films() const { return films_; }
    const WavefrontStatistics& statistics() const { return statistics_; }
    std::size_t device_bytes() const;

private:
    /// Pixels of one strip of a film.
    struct Batch {
        const DeviceFilm::Strip* strip;
        BatchRecord record;
        std::uint32_t paths() const { return record.pixels * record.samples; }
    };

    void build_kernels(const RenderFeatures& features, BuildStatistics& build);
    void trace_pixels(const BatchRecord& pass,
                      const std::function<std::uint32_t(std::uint32_t)>& place_of);
    void trace_batch(const BatchRecord& record, std::size_t strip);
    void add_layers(const BatchRecord& record, std::size_t strip);
    void trace_paths(const Batch& work);
    bool walks_fit();
    /// Work-items for so many paths.
    std::size_t spans_of(std::uint32_t paths) const;
    void generate(const Batch& work);
    void keep_live(const Batch& work, std::uint32_t depth);
    void trace(const Batch& work, std::uint32_t depth);
    void show_rays(const RaysToHit& rays, const RaysToBlock& shadow_rays) const;
    void shade(std::uint32_t depth);
    void gather(const Batch& work);
    void add_to_film(const Batch& work);
    DeviceArray<std::uint32_t>::Mapping map_live(cl_map_flags flags, std::uint32_t depth,
                                                 std::size_t count) const;
    void launch(const Kernel& kernel, std::size_t items, double& stage_seconds);
    void finish_kernels();

    const Device& device_;
    const Geometry& geometry_;
    RaySink on_rays_;
    int threads_;
    std::uint32_t depths_;         ///< rays of a path at most
    std::uint32_t paths_together_; ///< of a work-item
    bool walks_;
    std::vector<std::uint32_t> passed_sheets_; ///< as in RenderPlan
    RenderRecord render_;
    WavefrontStatistics statistics_;
    /// Kernels that were queued, and where their time goes.
    std::vector<std::pair<cl::Event, double*>> launched_;
    Kernel generate_, shade_, gather_, film_kernel_;
    WavefrontBuffers buffers_;
    std::vector<DeviceFilm> films_; ///< of equal strips
    /// Counts of the batch's paths that reach an even and an odd depth.
    std::array<std::uint32_t, 2> live_count_{};
};

} // namespace reradiant
