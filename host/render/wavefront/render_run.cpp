#include "host/render/wavefront/render_run.h"

#include "host/render/film/error_estimate.h"

#include <utility>

namespace reradiant {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

FilmResolver film_resolver(const RenderPlan& plan, const Scene& scene) {
    return {plan.film, scene.film.width, scene.film.height, plan.wavelengths.film};
}

/// Takes the film out of the wavefront; the image needs no memory on top of it.
void finish_film(RenderResult& result, Wavefront& wavefront, FilmResolver resolver) {
    wavefront.film().take([&](const FilmStrip& strip) {
        resolver.add(strip);
        result.non_finite += strip.refused();
    });
    result.image = resolver.take();
}

/// Takes the films of the layers out of the wavefront, as finish_film does with the image's.
void finish_layers(RenderResult& result, Wavefront& wavefront, const RenderPlan& plan) {
    const int bands = plan.wavelengths.film.count;
    for (std::size_t k = 0; k < plan.lights.layers.size(); ++k) {
        LightLayer layer = plan.lights.layers[k].layer;
        layer.values.reserve(plan.pixels * static_cast<std::size_t>(bands));
        wavefront.films()[k + 1].take(
            [&](const FilmStrip& strip) { append_means(strip, plan.film, bands, layer.values); });
        result.light_layers.push_back(std::move(layer));
    }
}

void collect(RenderResult& result, const Wavefront& wavefront, const RenderPlan& plan,
             const SceneTables& tables) {
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
    result.features = plan.features.listed();
    result.left_out = plan.left_out();
    result.notes = tables.notes;
}

} // namespace

RenderRun::RenderRun(const Scene& scene, const Device& device, const RenderOptions& options)
    : scene_(scene), options_(options), plan_(plan_render(scene, device.info(), options)),
      tables_(build_scene_tables(scene, plan_)),
      geometry_(scene, plan_.features.textures || plan_.features.reflectance_image),
      wavefront_(device, geometry_, plan_, tables_, options.threads,
                 options.hooks ? options.hooks->on_rays : RaySink{}, result_.build),
      checkpoint_(scene, device, options) {
    result_.plan = plan_.wavelengths;
    result_.setup_seconds = seconds_since(start_) - result_.build.seconds;
    rendering_ = Clock::now();
    if (options.hooks && options.hooks->on_set_up)
        options.hooks->on_set_up();
}

void RenderRun::resume() {
    state_ = checkpoint_.resume(wavefront_, result_);
    seconds_before_ = state_.seconds;
    rendering_ = Clock::now();
}

bool RenderRun::must_stop() const {
    const bool begun = state_.samples > 0; // one pass there is, however little time
    return state_.samples >= options_.samples ||
           (begun && counted_seconds() >= options_.time_seconds) ||
           (options_.relmse > 0.0 && state_.relmse <= options_.relmse);
}

double RenderRun::seconds() const {
    return seconds_before_ + seconds_since(rendering_) - observing_seconds_;
}

double RenderRun::counted_seconds() const {
    return options_.hooks && options_.hooks->time_counts_from
               ? seconds_before_ + seconds_since(*options_.hooks->time_counts_from)
               : state_.seconds;
}

/// An estimate takes about as long as a sample of a simple scene: the many short passes at the
/// beginning go without, but where somebody looks or samples or the end depend on it.
bool RenderRun::wants_estimate(bool observed) const {
    constexpr std::uint32_t short_passes = 64, growth = 4;
    return observed || options_.relmse > 0.0 || state_.samples >= short_passes ||
           state_.samples >= growth * estimated_samples_ || must_stop();
}

void RenderRun::estimate_error() {
    estimated_samples_ = state_.samples;
    wavefront_.film().read([&](FilmSums film) {
        const RelmseEstimate estimate =
            estimated_relmse(film, plan_.film, scene_.film.width, result_.plan.film.count,
                             options_.adaptive ? &errors_ : nullptr);
        state_.relmse = estimate.value;
        state_.relmse_low = estimate.low;
        state_.relmse_high = estimate.high;
    });
}

std::vector<float> RenderRun::pixel_errors() {
    if (errors_.empty()) // there was no estimate of this film
        wavefront_.film().read([&](FilmSums film) {
            errors_ = deciding_errors(film, plan_.film, scene_.film.width, result_.plan.film.count);
        });
    return std::exchange(errors_, {});
}

SpectralImage RenderRun::image_so_far() const {
    FilmResolver resolver = film_resolver(plan_, scene_);
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
    state_.relmse = state_.relmse_high = std::numeric_limits<double>::infinity();
    state_.relmse_low = 0.0;
    errors_.clear(); // they are of the pass before
    if (wants_estimate(static_cast<bool>(observe)))
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
    collect(result_, wavefront_, plan_, tables_);
    result_.total_seconds = seconds_since(start_);
    return std::move(result_);
}

RenderResult RenderRun::finish_with_image() {
    if (estimated_samples_ != state_.samples) // it was interrupted, or resumed at its end
        estimate_error();
    finish_film(result_, wavefront_, film_resolver(plan_, scene_));
    finish_layers(result_, wavefront_, plan_);
    return finish();
}

} // namespace reradiant
