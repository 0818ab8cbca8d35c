#pragma once

#include "host/device/buffer.h"
#include "host/device/opencl_device.h"
#include "host/device/program.h"
#include "host/geometry/geometry.h"
#include "host/render/film/device_film.h"
#include "host/render/film/film_sums.h"
#include "host/render/tables/scene_tables.h"
#include "host/render/wavefront/render_hooks.h"
#include "reradiant/device.h"

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

/// Chunks of events that walks have at first; a batch that needs more gets more.
inline constexpr std::size_t walk_chunks_a_path = 4;

struct WavefrontSettings {
    std::uint32_t max_depth = 8, min_depth = 3;
    std::uint32_t seed = 0;
    std::size_t batch_paths = 1u << 15;
    int threads = 0;
    std::uint32_t sequence_blocks = 0; ///< a path's first blocks, from the sequence (sequence.h)
    bool adaptive = false;             ///< passes of chosen pixels will come
    RaySink on_rays = {};
};

/// The wavefront path tracer: stages on the device, rays on the host (kernels/README.md).
class Wavefront {
public:
    Wavefront(const Device& device, const Geometry& geometry, const SceneTables& scene,
              const WavelengthPlan& plan, const WavefrontSettings& settings,
              BuildStatistics& build);

    /// Adds samples [first_sample, first_sample + samples) of every pixel to the film.
    void render_pass(std::uint32_t first_sample, std::uint32_t samples);
    /// Adds so many samples of chosen pixels, which ascend. Needs WavefrontSettings::adaptive.
    void render_pass(std::span<const PixelSamples> pixels, std::uint32_t samples);

    DeviceFilm& film() { return film_; }
    const DeviceFilm& film() const { return film_; }
    const WavefrontStatistics& statistics() const { return statistics_; }
    std::size_t device_bytes() const;

private:
    struct Batch {
        const DeviceFilm::Strip* strip;
        /// The first pixel, or its place in `chosen_`; the first sample, or what is added to it.
        std::uint32_t first_pixel, pixels, first_sample, samples;
        bool chosen = false;
        std::uint32_t paths() const { return pixels * samples; }
    };

    void build_kernels(BuildStatistics& build);
    void trace_batch(const Batch& batch);
    void trace_paths(const Batch& batch);
    bool walks_fit();
    void generate(const Batch& batch);
    void keep_live(const Batch& batch, std::uint32_t depth);
    void trace(const Batch& batch, std::uint32_t depth);
    void show_rays(const RaysToHit& rays, const RaysToBlock& shadow_rays) const;
    void shade(std::uint32_t depth);
    void gather(const Batch& batch);
    void add_to_film(const Batch& batch);
    void launch(const Kernel& kernel, std::size_t items, double& stage_seconds);
    void finish_kernels();

    const Device& device_;
    const Geometry& geometry_;
    const SceneTables& scene_;
    WavefrontSettings settings_;
    int phases_, lanes_;
    std::array<int, 2> seen_lanes_;
    FilmLayout film_layout_;
    std::uint32_t pixel_count_, capacity_, rounds_;
    bool samples_lights_;
    WavefrontStatistics statistics_;
    /// Kernels that were queued, and where their time goes.
    std::vector<std::pair<cl::Event, double*>> launched_;

    Kernel generate_, shade_, gather_, film_kernel_;
    DeviceArray<MaterialRecord> materials_;
    DeviceArray<LayerRecord> layers_;
    DeviceArray<LobeRecord> lobes_;
    DeviceArray<SurfaceRecord> surfaces_;
    DeviceArray<TextureRecord> textures_;
    DeviceArray<LightRecord> lights_;
    DeviceArray<WalkPartRecord> walk_parts_;
    DeviceArray<WalkChunk> walk_chunks_;
    DeviceArray<std::uint32_t> walk_chunks_used_;
    DeviceArray<WalkVertexRecord> walk_vertices_;
    DeviceArray<std::uint32_t> hero_lanes_; ///< [depth][path][hero_width]
    DeviceArray<float> hero_weights_;
    DeviceArray<float> tables_, colours_;
    DeviceArray<RayRecord> rays_, shadow_rays_;
    DeviceArray<HitRecord> hits_;
    /// The batch's paths that reach a depth, of even and of odd ones, and how many.
    std::array<DeviceArray<std::uint32_t>, 2> live_;
    std::array<std::uint32_t, 2> live_count_{};
    DeviceArray<std::uint8_t> goes_on_; ///< per live path: 1 where it reaches the next depth
    DeviceArray<PathState> paths_;
    DeviceArray<PixelSamples> chosen_; ///< the pass's pixels, where those are not all
    DeviceArray<VertexRecord> vertices_;
    DeviceArray<float> lobe_weights_, radiance_;
    DeviceFilm film_;
    DeviceArray<std::int32_t> film_bands_;
    DeviceArray<float> film_weights_, y_weights_;
};

} // namespace reradiant
