#include "host/render/wavefront/render_run.h"

#include "host/device/opencl_device.h"
#include "host/render/film/error_estimate.h"
#include "host/render/film/film_sums.h"
#include "host/render/plan/render_memory.h"

namespace reradiant {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RenderResult planned(const Scene& scene, const Device& device, const RenderOptions& options) {
    if (options.in_double)
        check_double(device.info());
    RenderResult result;
    result.plan =
        plan_wavelengths(scene, options.bands.value_or(film_bands(scene)), options.wavelengths);
    check_render_memory(scene, result.plan, options);
    return result;
}

SceneTables prepare_tables(const Scene& scene, const WavelengthPlan& plan,
                           const RenderOptions& options) {
    const RenderFeatures at_least = options.all_features ? RenderFeatures::all()
                                    : options.also_on.empty()
                                        ? RenderFeatures{}
                                        : RenderFeatures::only(options.also_on);
    SceneTables tables = build_scene_tables(scene, plan, options.model, at_least);
    const FilmLayout layout =
        film_layout(plan, options.band_variance || at_least.band_variance, at_least.scatter);
    tables.features.scatter = layout.scatter;
    tables.features.band_variance = layout.band_variance;
    tables.features.in_double = options.in_double;
    return tables;
}

/// The camera's numbers, and those for light and direction at the first three vertices, come from
/// the sequence: later ones are smoothed by those before them. Variances per band are those of
/// independent samples, so that parts of a render can be put together.
std::uint32_t sequence_blocks(const RenderOptions& options) {
    return options.band_variance ? 0 : 7;
}

WavefrontSettings wavefront_settings(const Scene& scene, const RenderOptions& options) {
    return {static_cast<std::uint32_t>(scene.integrator.max_depth),
            static_cast<std::uint32_t>(scene.integrator.min_depth),
            options.seed,
            options.batch_paths,
            options.threads,
            sequence_blocks(options),
            options.adaptive,
            options.hooks ? options.hooks->on_rays : RaySink{}};
}

FilmLayout film_of(const WavelengthPlan& plan, const SceneTables& tables,
                   const RenderOptions& options) {
    FilmLayout layout = film_layout(plan, tables.features.band_variance, tables.features.scatter);
    layout.independent_samples = sequence_blocks(options) == 0;
    layout.begins_odd = options.first_sample % 2 == 1;
    return layout;
}

FilmResolver film_resolver(const FilmLayout& layout, const Scene& scene,
                           const WavelengthPlan& plan) {
    return {layout, scene.film.width, scene.film.height, plan.film};
}

/// Takes the film out of the wavefront; the image needs no memory on top of it.
void finish_film(RenderResult& result, Wavefront& wavefront, FilmResolver resolver) {
    wavefront.film().take([&](const FilmStrip& strip) {
        resolver.add(strip);
        result.non_finite += strip.refused();
    });
    result.image = resolver.take();
}

void collect(RenderResult& result, const Wavefront& wavefront, const SceneTables& tables) {
    const WavefrontStatistics& statistics = wavefront.statistics();
    result.stage_seconds = {
        {"generate", statistics.generate_seconds}, {"intersect", statistics.intersect_seconds},
        {"shade", statistics.shade_seconds},       {"occlude", statistics.occlude_seconds},
        {"gather", statistics.gather_seconds},     {"film", statistics.film_seconds}};
    result.trace_seconds = statistics.intersect_seconds + statistics.occlude_seconds;
    result.shade_seconds = statistics.generate_seconds + statistics.shade_seconds +
                           statistics.gather_seconds + statistics.film_seconds;
    result.paths += statistics.paths; // on top of a resumed render's
    result.rays += statistics.rays;
    result.build_seconds = result.build.seconds;
    result.mapped_bytes = statistics.mapped_bytes;
    result.device_bytes = wavefront.device_bytes();
    result.table_bytes = tables.tables.size() * sizeof(float);
    result.features = tables.features.listed();
    result.left_out = tables.features.left_out();
    result.left_out.insert(result.left_out.end(), result.plan.left_out.begin(),
                           result.plan.left_out.end());
    result.notes = tables.notes;
}

} // namespace

RenderRun::RenderRun(const Scene& scene, const Device& device, const RenderOptions& options)
    : scene_(scene), options_(options), result_(planned(scene, device, options)),
      tables_(prepare_tables(scene, result_.plan, options)),
      geometry_(scene, tables_.features.textures || tables_.features.reflectance_image),
      wavefront_(device, geometry_, tables_, result_.plan, wavefront_settings(scene, options),
                 result_.build),
      layout_(film_of(result_.plan, tables_, options)), checkpoint_(scene, device, options) {
    result_.setup_seconds = seconds_since(start_) - result_.build.seconds;
    rendering_ = Clock::now();
}

void RenderRun::resume() {
    state_ = checkpoint_.resume(wavefront_, result_);
    seconds_before_ = state_.seconds;
    rendering_ = Clock::now();
}

bool RenderRun::must_stop() const {
    return state_.samples >= options_.samples || state_.seconds >= options_.time_seconds ||
           (options_.relmse > 0.0 && state_.relmse <= options_.relmse);
}

double RenderRun::seconds() const {
    return seconds_before_ + seconds_since(rendering_) - observing_seconds_;
}

void RenderRun::estimate_error() {
    wavefront_.film().read([&](FilmSums film) {
        const RelmseEstimate estimate = estimated_relmse(film, layout_, result_.plan.film.count,
                                                         options_.adaptive ? &errors_ : nullptr);
        state_.relmse = estimate.value;
        state_.relmse_low = estimate.low;
        state_.relmse_high = estimate.high;
    });
}

std::span<const float> RenderRun::pixel_errors() {
    if (errors_.empty()) // as they are when a render was resumed
        estimate_error();
    return errors_;
}

SpectralImage RenderRun::image_so_far() const {
    FilmResolver resolver = film_resolver(layout_, scene_, result_.plan);
    wavefront_.film().read([&](FilmSums film) {
        for (const FilmStrip& strip : film)
            resolver.add(strip);
    });
    return resolver.take();
}

void RenderRun::after_pass(std::uint32_t samples, const RenderObserver& observe,
                           const std::function<bool(const RenderProgress&)>& goes_on) {
    state_.samples = samples;
    state_.seconds = seconds();
    estimate_error();
    result_.passes.push_back(state_);
    if (observe) {
        const Clock::time_point start = Clock::now();
        observe(state_, [&] { return image_so_far(); });
        observing_seconds_ += seconds_since(start);
    }
    result_.interrupted = goes_on && !goes_on(state_);
    checkpoint_.after_pass(wavefront_, result_);
}

RenderResult RenderRun::finish() {
    result_.samples = state_.samples;
    result_.relmse = state_.relmse;
    collect(result_, wavefront_, tables_);
    result_.total_seconds = seconds_since(start_);
    return std::move(result_);
}

RenderResult RenderRun::finish_with_image() {
    finish_film(result_, wavefront_, film_resolver(layout_, scene_, result_.plan));
    return finish();
}

} // namespace reradiant
