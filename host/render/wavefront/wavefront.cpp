#include "host/render/wavefront/wavefront.h"

#include "kernels/stages/arguments.h"

#include <algorithm>
#include <chrono>
#include <numeric>

namespace reradiant {

namespace {

/// Work-items of a group: few enough for any device's limit, and little private memory in all
/// (PoCL lays out a whole group's private memory on one stack).
constexpr std::size_t scalar_group = 32;
constexpr std::size_t vector_group = 8;

/// Paths whose random numbers a work-item of `generate` and `shade` makes at once. A CPU has the
/// vectors for them; where work-items share the lanes of a wide processor each has a path.
std::uint32_t together_on(const DeviceInfo& device) {
    return device.type == "CPU" ? 16 : 1;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RenderRecord render_record(const RenderPlan& plan, const SceneTables& scene) {
    const auto [first_seen, seen] = plan.wavelengths.seen_lanes();
    return {scene.camera,
            scene.image,
            scene.environment,
            scene.sampled_lights,
            plan.max_depth,
            plan.min_depth,
            static_cast<std::uint32_t>(plan.wavelengths.phases),
            static_cast<std::uint32_t>(first_seen),
            static_cast<std::uint32_t>(seen),
            plan.sequence_blocks,
            plan.seed,
            plan.path_capacity};
}

// The lists of kernels/stages/arguments.h become the arguments of a call: arrays by their names
// among the buffers, or the strip's, and records by the names that they have where the call stands.
template <typename T>
const cl::Buffer& bound_array(const DeviceArray<T>& array) {
    return array.buffer();
}
template <typename T>
const T& bound_record(const T& record) {
    return record;
}
#define BOUND_ARRAY(type, name) bound_array<type>(buffers_.name)
#define BOUND_STRIP(type, name) bound_array<type>(work.strip->name)
#define BOUND_RECORD(type, name) bound_record<type>(name)
#define BOUND(list) list(BOUND_ARRAY, BOUND_ARRAY, BOUND_STRIP, BOUND_RECORD)

} // namespace

Wavefront::Wavefront(const Device& device, const Geometry& geometry, const RenderPlan& plan,
                     const SceneTables& scene, int threads, const RaySink& on_rays,
                     BuildStatistics& build)
    : device_(device), geometry_(geometry), on_rays_(on_rays), threads_(threads),
      depths_(plan.depths), paths_together_(together_on(device.info())), walks_(plan.features.walk),
      passed_sheets_(plan.passed_sheets), render_(render_record(plan, scene)) {
    opencl_checked("setting up the renderer", [&] {
        build_kernels(plan.features, build);
        buffers_ = {device, plan, scene};
        for (std::uint64_t film = 0; film < plan.films(); ++film)
            films_.emplace_back(device, plan.film, static_cast<std::uint32_t>(plan.pixels));
        device_.opencl().queue.finish();
    });
}

void Wavefront::build_kernels(const RenderFeatures& features, BuildStatistics& build) {
    KernelDefines defines = features.defines();
    defines.emplace_back("PATHS_TOGETHER", paths_together_);
    const auto kernel = [&](const char* file, const char* name, std::size_t group) {
        return Kernel(build_program(device_, file, defines, &build), name, group);
    };
    const std::size_t spans = std::max<std::size_t>(scalar_group / paths_together_, 1);
    generate_ = kernel("kernels/generate.cl", "generate", spans);
    shade_ = kernel("kernels/shade.cl", "shade", spans);
    gather_ = kernel("kernels/gather.cl", "gather", vector_group);
    film_kernel_ = kernel("kernels/film.cl", "film", vector_group);
}

void Wavefront::render_pass(std::uint32_t first_sample, std::uint32_t samples) {
    trace_pixels({0, 0, 0, first_sample, samples, 0}, [](std::uint32_t pixel) { return pixel; });
}

void Wavefront::render_pass(std::span<const PixelSamples> pixels, std::uint32_t samples) {
    opencl_checked("choosing pixels", [&] {
        const auto chosen = buffers_.chosen.map(CL_MAP_WRITE, 0, pixels.size());
        std::copy(pixels.begin(), pixels.end(), chosen.span().begin());
    });
    trace_pixels({1, 0, 0, 0, samples, 0}, [pixels](std::uint32_t pixel) {
        return static_cast<std::uint32_t>( // first chosen one not before it
            std::ranges::lower_bound(pixels, pixel, {}, &PixelSamples::pixel) - pixels.begin());
    });
}

/// Traces a pass, of which `pass` says the samples and whether pixels are chosen, in batches that
/// fit. place_of: where a pixel stands among those of the pass.
void Wavefront::trace_pixels(const BatchRecord& pass,
                             const std::function<std::uint32_t(std::uint32_t)>& place_of) {
    opencl_checked("rendering", [&] {
        for (std::uint32_t done = 0; done < pass.samples;) {
            const std::uint32_t together = std::min(pass.samples - done, render_.capacity);
            const std::uint32_t most = render_.capacity / together;
            for (std::size_t s = 0; s < film().strips().size(); ++s) {
                const DeviceFilm::Strip& strip = film().strips()[s];
                const std::uint32_t end = place_of(strip.first_pixel + strip.pixels);
                for (std::uint32_t at = place_of(strip.first_pixel); at < end; at += most)
                    trace_batch({pass.chosen, at, std::min(most, end - at),
                                 pass.first_sample + done, together, strip.first_pixel},
                                s);
            }
            done += together;
        }
        finish_kernels();
    });
}

void Wavefront::trace_batch(const BatchRecord& record, std::size_t strip) {
    const Batch work{&film().strips()[strip], record};
    do
        trace_paths(work);
    while (!walks_fit());
    gather(work);
    add_to_film(work);
    add_layers(record, strip);
    statistics_.paths += work.paths();
}

/// Gathers the batch's paths again, with what each layer has of the lights: the operators at their
/// vertices are linear, so that layers add up to the image.
void Wavefront::add_layers(const BatchRecord& record, std::size_t strip) {
    for (std::size_t layer = 0; layer < buffers_.layer_lights.size(); ++layer) {
        const Batch work{&films_[layer + 1].strips()[strip], record};
        std::swap(buffers_.lights, buffers_.layer_lights[layer]);
        gather(work);
        std::swap(buffers_.lights, buffers_.layer_lights[layer]);
        add_to_film(work);
    }
}

void Wavefront::trace_paths(const Batch& work) {
    generate(work);
    if (walks_)
        buffers_.walk_chunks_used.fill_zero();
    for (std::uint32_t depth = 0;; ++depth) {
        finish_kernels();
        keep_live(work, depth);
        trace(work, depth);
        if (live_count_[depth % 2] == 0)
            return;
        shade(depth);
    }
}

/// Returns true when the walks of a batch found room for their events. If not it makes the room:
/// the walks are the same when the batch is traced again.
bool Wavefront::walks_fit() {
    if (!walks_)
        return true;
    std::size_t used = 0;
    {
        const auto counter = buffers_.walk_chunks_used.map(CL_MAP_READ, 0, 1);
        used = counter.span().front();
    }
    if (used <= buffers_.walk_chunks.size())
        return true;
    buffers_.walk_chunks = {}; // never two of them
    buffers_.walk_chunks = {device_, used + used / 4};
    return false;
}

std::size_t Wavefront::spans_of(std::uint32_t paths) const {
    return (paths + paths_together_ - 1) / paths_together_;
}

void Wavefront::generate(const Batch& work) {
    const RenderRecord& render = render_;
    const BatchRecord& batch = work.record;
    generate_.bind(BOUND(GENERATE_ARGUMENTS));
    launch(generate_, spans_of(work.paths()), statistics_.generate_seconds);
}

/// Maps the list of the paths that reach a depth.
DeviceArray<std::uint32_t>::Mapping Wavefront::map_live(cl_map_flags flags, std::uint32_t depth,
                                                        std::size_t count) const {
    return buffers_.live.map(flags, (depth % 2) * std::size_t{render_.capacity}, count);
}

/// Lists the paths that reach a depth: most end after few vertices, and the stages then work on
/// what is left.
void Wavefront::keep_live(const Batch& work, std::uint32_t depth) {
    std::uint32_t& kept = live_count_[depth % 2];
    kept = 0;
    if (depth == depths_)
        return;
    const auto live = map_live(CL_MAP_WRITE, depth, work.paths());
    if (depth == 0) {
        std::iota(live.span().begin(), live.span().end(), 0u);
        kept = work.paths();
        return;
    }
    const std::uint32_t candidates = live_count_[(depth - 1) % 2];
    const auto before = map_live(CL_MAP_READ, depth - 1, candidates);
    const auto goes_on = buffers_.goes_on.map(CL_MAP_READ, 0, candidates);
    for (std::uint32_t i = 0; i < candidates; ++i) { // without branches
        live.span()[kept] = before.span()[i];
        kept += goes_on.span()[i];
    }
}

/// Rays that reach a depth, together with the shadow rays of the depth before.
void Wavefront::trace(const Batch& work, std::uint32_t depth) {
    const auto start = std::chrono::steady_clock::now();
    const auto rays = buffers_.rays.map(CL_MAP_READ, 0, work.paths());
    const auto hits = buffers_.hits.map(CL_MAP_WRITE, 0, work.paths());
    const auto live = map_live(CL_MAP_READ, depth, live_count_[depth % 2]);
    const bool has_shadows = depth > 0 && render_.sampled_lights > 0;
    const std::uint32_t before = has_shadows ? depth - 1 : 0;
    const auto shadow_rays =
        buffers_.shadow_rays.map(CL_MAP_READ | CL_MAP_WRITE, std::size_t{before} * render_.capacity,
                                 has_shadows ? work.paths() : 0);
    const auto shadow_live =
        map_live(CL_MAP_READ, before, has_shadows ? live_count_[before % 2] : 0);
    const RaysToHit to_hit{rays.span(), hits.span(), live.span(), depth == 0};
    const bool passes = has_shadows && !passed_sheets_.empty();
    const auto crossings = buffers_.crossings.map(
        CL_MAP_WRITE, std::size_t{before} * render_.capacity * MOST_CROSSINGS,
        passes ? work.paths() * MOST_CROSSINGS : 0);
    RaysToBlock to_block{shadow_rays.span(), shadow_live.span()};
    if (passes) // as many as the path itself could meet
        to_block.sheets = {passed_sheets_, crossings.span(),
                           std::min<unsigned>(MOST_CROSSINGS, render_.max_depth - before - 1)};
    show_rays(to_hit, to_block);
    const TraceStatistics traced = geometry_.trace(to_hit, to_block, threads_);
    statistics_.rays += live.span().size() + traced.blockable;
    statistics_.mapped_bytes += rays.span().size_bytes() + hits.span().size_bytes() +
                                2 * shadow_rays.span().size_bytes(); // there and back
    const double both = traced.hit_seconds + traced.block_seconds;
    const double share = both > 0.0 ? traced.block_seconds / both : 0.0,
                 wall = seconds_since(start);
    statistics_.occlude_seconds += share * wall;
    statistics_.intersect_seconds += (1.0 - share) * wall;
}

void Wavefront::show_rays(const RaysToHit& rays, const RaysToBlock& shadow_rays) const {
    if (!on_rays_)
        return;
    std::vector<RayRecord> shown;
    for (const std::uint32_t path : shadow_rays.live)
        if (shadow_rays.rays[path].t_far >= 0.0f)
            shown.push_back(shadow_rays.rays[path]);
    on_rays_(shown, true, false);
    shown.clear();
    for (const std::uint32_t path : rays.live)
        shown.push_back(rays.rays[path]);
    on_rays_(shown, false, rays.coherent);
}

void Wavefront::shade(std::uint32_t depth) {
    const RenderRecord& render = render_;
    const DepthRecord now{depth, live_count_[depth % 2],
                          static_cast<std::uint32_t>(buffers_.walk_chunks.size())};
    shade_.bind(BOUND(SHADE_ARGUMENTS));
    launch(shade_, spans_of(now.live_paths), statistics_.shade_seconds);
}

void Wavefront::gather(const Batch& work) {
    const RenderRecord& render = render_;
    const BatchRecord& batch = work.record;
    gather_.bind(BOUND(GATHER_ARGUMENTS));
    launch(gather_, work.paths(), statistics_.gather_seconds);
}

void Wavefront::add_to_film(const Batch& work) {
    const BatchRecord& batch = work.record;
    film_kernel_.bind(BOUND(FILM_ARGUMENTS));
    launch(film_kernel_, batch.pixels, statistics_.film_seconds);
}

void Wavefront::launch(const Kernel& kernel, std::size_t items, double& stage_seconds) {
    launched_.emplace_back(kernel.launch(device_, items), &stage_seconds);
}

/// Waits for what was queued. The host waits before it traces rays only, so that the kernels that
/// end a batch and begin the next follow each other.
void Wavefront::finish_kernels() {
    device_.opencl().queue.finish();
    for (const auto& [event, seconds] : launched_)
        *seconds +=
            1e-9 * static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                       event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    launched_.clear();
}

std::size_t Wavefront::device_bytes() const {
    return buffers_.bytes() + films_.size() * film().bytes();
}

} // namespace reradiant
