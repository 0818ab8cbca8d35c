#include "host/render/wavefront/wavefront.h"

#include "host/render/tables/hero_tables.h"
#include "kernels/core/features.h"
#include "reradiant/error.h"

#include <algorithm>
#include <chrono>
#include <numeric>

namespace reradiant {

namespace {

/// Work-items of a group: few enough for any device's limit, and little private memory in all
/// (PoCL lays out a whole group's private memory on one stack).
constexpr std::size_t scalar_group = 32;
constexpr std::size_t vector_group = 8;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::uint32_t batch_capacity(const WavefrontSettings& settings, std::uint32_t pixels) {
    const std::size_t wanted = std::max<std::size_t>(settings.batch_paths, 1);
    return static_cast<std::uint32_t>(
        std::min<std::size_t>(wanted, static_cast<std::size_t>(pixels) * 1024u));
}

} // namespace

Wavefront::Wavefront(const Device& device, const Geometry& geometry, const SceneTables& scene,
                     const WavelengthPlan& plan, const WavefrontSettings& settings,
                     BuildStatistics& build)
    : device_(device), geometry_(geometry), scene_(scene), settings_(settings),
      phases_(plan.phases), lanes_(plan.padded_lanes()), seen_lanes_(plan.seen_lanes()),
      film_layout_(film_layout(plan, scene.features.band_variance, scene.features.scatter)),
      pixel_count_(scene.camera.width * scene.camera.height),
      capacity_(batch_capacity(settings, pixel_count_)),
      rounds_(settings.max_depth + (scene.features.area_lights || scene.features.environment ||
                                            scene.features.environment_image
                                        ? 1u
                                        : 0u)),
      samples_lights_(scene.sampled_lights > 0) {
    opencl_checked("setting up the renderer", [&] {
        build_kernels(build);
        materials_ = {device, std::span(scene.materials)};
        layers_ = {device, std::span(scene.layers)};
        lobes_ = {device, std::span(scene.lobes)};
        surfaces_ = {device, std::span(scene.surfaces)};
        textures_ = {device, std::span(scene.textures)};
        lights_ = {device, std::span(scene.lights)};
        walk_parts_ = {device, std::span(scene.walk_parts)};
        tables_ = {device, std::span(scene.tables)};
        const std::size_t slots = static_cast<std::size_t>(capacity_) * rounds_;
        rays_ = {device, capacity_};
        hits_ = {device, capacity_};
        live_ = {DeviceArray<std::uint32_t>{device, capacity_}, {device, capacity_}};
        goes_on_ = {device, capacity_};
        paths_ = {device, capacity_};
        chosen_ = {device, settings.adaptive ? std::size_t{pixel_count_} : 0};
        vertices_ = {device, slots};
        const bool sampling = scene.features.area_lights || scene.features.delta_lights ||
                              scene.features.environment_image;
        shadow_rays_ = {device, sampling ? slots : 0};
        const bool colours = scene.features.environment_image || scene.features.reflectance_image;
        colours_ = {device, colours ? slots * VERTEX_COLOURS : 0};
        const bool walks = scene.features.walk;
        walk_chunks_ = {device,
                        walks ? walk_chunks_a_path * static_cast<std::size_t>(capacity_) : 0};
        walk_chunks_used_ = {device, std::size_t{walks}};
        walk_vertices_ = {device, walks ? slots : 0};
        const std::size_t sets =
            plan.hero > 0 ? (slots + capacity_) * static_cast<std::size_t>(hero_width(plan.hero))
                          : 0;
        hero_lanes_ = {device, sets};
        hero_weights_ = {device, sets};
        lobe_weights_ = {device, slots * 2u * static_cast<std::size_t>(scene.features.lobes)};
        radiance_ = {device,
                     static_cast<std::size_t>(capacity_) * static_cast<std::size_t>(lanes_)};
        film_bands_ = {device, std::span<const std::int32_t>(film_layout_.lane_bands)};
        film_weights_ = {device, std::span<const float>(film_layout_.lane_weights)};
        y_weights_ = {device, std::span<const float>(film_layout_.y_weights)};
        film_ = {device, film_layout_, pixel_count_};
        device_.opencl().queue.finish();
    });
}

void Wavefront::build_kernels(BuildStatistics& build) {
    RenderFeatures features = scene_.features;
    features.scatter = film_layout_.scatter;
    features.film_chunks = film_layout_.lanes / WIDTH;
    const KernelDefines defines = features.defines();
    generate_ = {build_program(device_, "kernels/generate.cl", defines, &build), "generate",
                 scalar_group};
    shade_ = {build_program(device_, "kernels/shade.cl", defines, &build), "shade", scalar_group};
    gather_ = {build_program(device_, "kernels/gather.cl", defines, &build), "gather",
               vector_group};
    film_kernel_ = {build_program(device_, "kernels/film.cl", defines, &build), "film",
                    vector_group};
}

void Wavefront::render_pass(std::uint32_t first_sample, std::uint32_t samples) {
    opencl_checked("rendering", [&] {
        for (std::uint32_t done = 0; done < samples;) {
            const std::uint32_t together = std::min(samples - done, capacity_);
            const std::uint32_t pixels_at_once = capacity_ / together;
            for (const DeviceFilm::Strip& strip : film_.strips())
                for (std::uint32_t first = 0; first < strip.pixels; first += pixels_at_once)
                    trace_batch({&strip, strip.first_pixel + first,
                                 std::min(pixels_at_once, strip.pixels - first),
                                 first_sample + done, together});
            done += together;
        }
        finish_kernels();
    });
}

void Wavefront::render_pass(std::span<const PixelSamples> pixels, std::uint32_t samples) {
    opencl_checked("rendering", [&] {
        {
            const auto chosen = chosen_.map(CL_MAP_WRITE, 0, pixels.size());
            std::copy(pixels.begin(), pixels.end(), chosen.span().begin());
        }
        const auto place_of = [&](std::uint32_t pixel) { // first chosen one not before it
            return static_cast<std::uint32_t>(
                std::ranges::lower_bound(pixels, pixel, {}, &PixelSamples::pixel) - pixels.begin());
        };
        for (std::uint32_t done = 0; done < samples;) {
            const std::uint32_t together = std::min(samples - done, capacity_);
            const std::uint32_t pixels_at_once = capacity_ / together;
            for (const DeviceFilm::Strip& strip : film_.strips()) {
                const std::uint32_t end = place_of(strip.first_pixel + strip.pixels);
                for (std::uint32_t first = place_of(strip.first_pixel); first < end;
                     first += pixels_at_once)
                    trace_batch({&strip, first, std::min(pixels_at_once, end - first), done,
                                 together, true});
            }
            done += together;
        }
        finish_kernels();
    });
}

void Wavefront::trace_batch(const Batch& batch) {
    do
        trace_paths(batch);
    while (!walks_fit());
    gather(batch);
    add_to_film(batch);
    statistics_.paths += batch.paths();
}

void Wavefront::trace_paths(const Batch& batch) {
    generate(batch);
    if (scene_.features.walk)
        walk_chunks_used_.fill_zero();
    for (std::uint32_t depth = 0;; ++depth) {
        finish_kernels();
        keep_live(batch, depth);
        trace(batch, depth);
        if (live_count_[depth % 2] == 0)
            return;
        shade(depth);
    }
}

/// Returns true when the walks of a batch found room for their events. If not it makes the room:
/// the walks are the same when the batch is traced again.
bool Wavefront::walks_fit() {
    if (!scene_.features.walk)
        return true;
    std::size_t used = 0;
    {
        const auto counter = walk_chunks_used_.map(CL_MAP_READ, 0, 1);
        used = counter.span().front();
    }
    if (used <= walk_chunks_.size())
        return true;
    walk_chunks_ = {}; // never two of them
    walk_chunks_ = {device_, used + used / 4};
    return false;
}

void Wavefront::generate(const Batch& batch) {
    generate_.bind(rays_.buffer(), paths_.buffer(), chosen_.buffer(),
                   static_cast<std::uint32_t>(batch.chosen), scene_.camera, batch.first_pixel,
                   batch.first_sample, batch.samples, batch.paths(),
                   static_cast<std::uint32_t>(phases_), settings_.sequence_blocks, settings_.seed);
    launch(generate_, batch.paths(), statistics_.generate_seconds);
}

/// Lists the paths that reach a depth: most end after few vertices, and the stages then work on
/// what is left.
void Wavefront::keep_live(const Batch& batch, std::uint32_t depth) {
    std::uint32_t& kept = live_count_[depth % 2];
    kept = 0;
    if (depth == rounds_)
        return;
    const auto live = live_[depth % 2].map(CL_MAP_WRITE, 0, batch.paths());
    if (depth == 0) {
        std::iota(live.span().begin(), live.span().end(), 0u);
        kept = batch.paths();
        return;
    }
    const std::uint32_t candidates = live_count_[(depth - 1) % 2];
    const auto before = live_[(depth - 1) % 2].map(CL_MAP_READ, 0, candidates);
    const auto goes_on = goes_on_.map(CL_MAP_READ, 0, candidates);
    for (std::uint32_t i = 0; i < candidates; ++i) { // without branches
        live.span()[kept] = before.span()[i];
        kept += goes_on.span()[i];
    }
}

/// Rays that reach a depth, together with the shadow rays of the depth before.
void Wavefront::trace(const Batch& batch, std::uint32_t depth) {
    const auto start = std::chrono::steady_clock::now();
    const auto rays = rays_.map(CL_MAP_READ, 0, batch.paths());
    const auto hits = hits_.map(CL_MAP_WRITE, 0, batch.paths());
    const auto live = live_[depth % 2].map(CL_MAP_READ, 0, live_count_[depth % 2]);
    const bool has_shadows = depth > 0 && samples_lights_;
    const std::size_t before = has_shadows ? depth - 1 : 0;
    const auto shadow_rays = shadow_rays_.map(CL_MAP_READ | CL_MAP_WRITE, before * capacity_,
                                              has_shadows ? batch.paths() : 0);
    const auto shadow_live =
        live_[before % 2].map(CL_MAP_READ, 0, has_shadows ? live_count_[before % 2] : 0);
    const RaysToHit to_hit{rays.span(), hits.span(), live.span(), depth == 0};
    const RaysToBlock to_block{shadow_rays.span(), shadow_live.span()};
    show_rays(to_hit, to_block);
    const TraceStatistics traced = geometry_.trace(to_hit, to_block, settings_.threads);
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
    if (!settings_.on_rays)
        return;
    std::vector<RayRecord> shown;
    for (const std::uint32_t path : shadow_rays.live)
        if (shadow_rays.rays[path].t_far >= 0.0f)
            shown.push_back(shadow_rays.rays[path]);
    settings_.on_rays(shown, true, false);
    shown.clear();
    for (const std::uint32_t path : rays.live)
        shown.push_back(rays.rays[path]);
    settings_.on_rays(shown, false, rays.coherent);
}

void Wavefront::shade(std::uint32_t depth) {
    const std::uint32_t live_count = live_count_[depth % 2];
    shade_.bind(rays_.buffer(), hits_.buffer(), paths_.buffer(), vertices_.buffer(),
                shadow_rays_.buffer(), lobe_weights_.buffer(), colours_.buffer(),
                materials_.buffer(), layers_.buffer(), lobes_.buffer(), surfaces_.buffer(),
                textures_.buffer(), lights_.buffer(), tables_.buffer(), walk_parts_.buffer(),
                walk_chunks_.buffer(), walk_chunks_used_.buffer(), walk_vertices_.buffer(),
                live_[depth % 2].buffer(), goes_on_.buffer(), scene_.image,
                static_cast<std::uint32_t>(walk_chunks_.size()), live_count, capacity_, depth,
                settings_.max_depth, settings_.min_depth, scene_.sampled_lights, scene_.environment,
                settings_.sequence_blocks, settings_.seed);
    launch(shade_, live_count, statistics_.shade_seconds);
}

void Wavefront::gather(const Batch& batch) {
    gather_.bind(radiance_.buffer(), paths_.buffer(), vertices_.buffer(), shadow_rays_.buffer(),
                 lobe_weights_.buffer(), colours_.buffer(), materials_.buffer(), layers_.buffer(),
                 lobes_.buffer(), lights_.buffer(), tables_.buffer(), walk_parts_.buffer(),
                 walk_chunks_.buffer(), walk_vertices_.buffer(), hero_lanes_.buffer(),
                 hero_weights_.buffer(), static_cast<std::uint32_t>(seen_lanes_[0]),
                 static_cast<std::uint32_t>(seen_lanes_[1]), scene_.image.light, batch.paths(),
                 capacity_, static_cast<std::uint32_t>(phases_), settings_.seed);
    launch(gather_, batch.paths(), statistics_.gather_seconds);
}

void Wavefront::add_to_film(const Batch& batch) {
    film_kernel_.bind(batch.strip->sums.buffer(), batch.strip->statistics.buffer(),
                      radiance_.buffer(), paths_.buffer(), film_bands_.buffer(),
                      film_weights_.buffer(), y_weights_.buffer(), batch.strip->first_pixel,
                      batch.samples, batch.pixels);
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
    return materials_.bytes() + layers_.bytes() + lobes_.bytes() + surfaces_.bytes() +
           walk_parts_.bytes() + walk_chunks_.bytes() + walk_vertices_.bytes() + textures_.bytes() +
           hero_lanes_.bytes() + hero_weights_.bytes() + colours_.bytes() + lights_.bytes() +
           tables_.bytes() + rays_.bytes() + shadow_rays_.bytes() + hits_.bytes() +
           2 * live_[0].bytes() + goes_on_.bytes() + paths_.bytes() + chosen_.bytes() +
           vertices_.bytes() + lobe_weights_.bytes() + radiance_.bytes() + film_.bytes() +
           film_bands_.bytes() + film_weights_.bytes() + y_weights_.bytes();
}

} // namespace reradiant
