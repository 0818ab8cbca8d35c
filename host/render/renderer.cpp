#include "host/render/renderer.h"

#include "host/error.h"
#include "host/geometry/geometry.h"
#include "host/render/checkpoint.h"
#include "host/render/film_sums.h"
#include "host/render/hero_tables.h"
#include "host/render/render_identity.h"
#include "host/render/scene_tables.h"
#include "host/render/stack_optics.h"
#include "host/render/wavefront.h"
#include "host/scene/model_choice.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <unistd.h>

namespace reradiant {

namespace {

using Clock = std::chrono::steady_clock;

/// Samples of a pass: between passes the film is read and the stop rules are checked.
constexpr std::uint32_t samples_in_pass = 64;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double seconds_of(const std::function<void()>& work) {
    const Clock::time_point start = Clock::now();
    work();
    return seconds_since(start);
}

std::uint64_t machine_memory_bytes() {
    return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE));
}

void check_memory(const Scene& scene, const WavelengthPlan& plan, const RenderOptions& options) {
    const std::uint64_t limit =
        options.memory_limit_bytes ? options.memory_limit_bytes : machine_memory_bytes() / 5 * 4;
    const std::uint64_t needed = predicted_render_bytes(scene, plan, options);
    if (needed > limit)
        throw_input_error(
            {scene.file.string()},
            fmt::format("the render would take {} bytes, the limit is {}", needed, limit),
            "make the film smaller, take fewer bands or raise --memory-limit");
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

/// Doubling passes: the first ones show and estimate early, later ones cost little to stop, and
/// take a sixteenth of what is done, so that their number stays small. None is longer than the time
/// between two checkpoints.
std::uint32_t next_pass(const RenderProgress& state, const RenderOptions& options) {
    const std::uint32_t done = state.samples;
    std::uint32_t size = std::max(std::clamp<std::uint32_t>(done, 1, samples_in_pass), done / 16);
    const double affordable = done * options.checkpoint_seconds / std::max(state.seconds, 1e-9);
    if (!options.checkpoint.empty() && done > 0 && affordable < size)
        size = std::max(1u, static_cast<std::uint32_t>(affordable));
    return std::min(size, options.samples - done);
}

bool must_stop(const RenderProgress& state, const RenderOptions& options) {
    return state.samples >= options.samples || state.seconds >= options.time_seconds ||
           (options.relmse > 0.0 && state.relmse <= options.relmse);
}

void estimate_error(RenderProgress& state, FilmSums film, const FilmLayout& layout,
                    const WavelengthPlan& plan) {
    const RelmseEstimate estimate = estimated_relmse(film, layout, plan.film.count, state.samples);
    state.relmse = estimate.value;
    state.relmse_low = estimate.low;
    state.relmse_high = estimate.high;
}

FilmResolver film_resolver(const FilmLayout& layout, const Scene& scene, const WavelengthPlan& plan,
                           const RenderProgress& state) {
    return {layout, scene.film.width, scene.film.height, plan.film, state.samples};
}

SpectralImage resolved(const Wavefront& wavefront, FilmResolver resolver) {
    wavefront.film().read([&](FilmSums film) {
        for (const FilmStrip& strip : film)
            resolver.add(strip);
    });
    return resolver.take();
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

/// What models need of a path's vertices, and of a path that walks.
struct ModelBytes {
    std::uint64_t vertex = 0, path = 0;
};
ModelBytes model_bytes(const Scene& scene, const WavelengthPlan& plan, Model requested) {
    int most_lobes = 0;
    bool walks = false;
    for (const Material& material : scene.materials) {
        const Model model = choose_model(material, requested, use_in(plan)).model;
        walks |= model == Model::Walk;
        if (model != Model::Walk)
            most_lobes = std::max(most_lobes, deeper_lobe_count(material, model));
    }
    ModelBytes bytes{2 * sizeof(float) * static_cast<std::uint64_t>(most_lobes), 0};
    if (walks) {
        bytes.vertex += sizeof(WalkVertexRecord);
        bytes.path += walk_chunks_a_path * sizeof(WalkChunk);
    }
    return bytes;
}

/// Whether images colour lights or reflectances, so that vertices keep colours.
bool has_colours(const Scene& scene) {
    const auto is_image = [](const Light& light) {
        const auto* sky = std::get_if<EnvironmentLight>(&light);
        return sky != nullptr && sky->image >= 0;
    };
    return std::any_of(scene.lights.begin(), scene.lights.end(), is_image) ||
           std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& m) { return m.substrate.reflectance_image >= 0; });
}

/// The checkpoint file of one render.
class Checkpoints {
public:
    Checkpoints(const Scene& scene, const Device& device, const RenderOptions& options)
        : options_(options) {
        if (!options.checkpoint.empty())
            head_.identity = render_identity(scene, device, options);
    }

    /// The state to go on from: that of the checkpoint where there is one and it is asked for.
    RenderProgress resume(Wavefront& wavefront, RenderResult& result) const {
        std::error_code ignored;
        if (options_.checkpoint.empty() || !options_.resume ||
            !std::filesystem::exists(options_.checkpoint, ignored))
            return {};
        const RenderCheckpoint kept =
            read_checkpoint(options_.checkpoint, head_.identity, wavefront.film().float_count());
        wavefront.film().restore(kept.sums, kept.statistics);
        result.passes = kept.passes;
        result.paths = kept.paths;
        result.rays = kept.rays;
        result.resumed_samples = kept.passes.back().samples;
        return kept.passes.back();
    }

    /// Writes one when it is time, and for an interrupted render. Keeps the share of time that goes
    /// into writing below a tenth.
    void after_pass(const Wavefront& wavefront, const RenderResult& result) {
        if (options_.checkpoint.empty() ||
            (!result.interrupted && seconds_since(written_) < std::max(options_.checkpoint_seconds,
                                                                       10.0 * write_seconds_)))
            return;
        const Clock::time_point start = Clock::now();
        head_.passes = result.passes;
        head_.paths = result.paths + wavefront.statistics().paths;
        head_.rays = result.rays + wavefront.statistics().rays;
        try {
            wavefront.film().read(
                [&](FilmSums film) { write_checkpoint(options_.checkpoint, head_, film); });
        } catch (const Error& error) {
            // A full disk costs the checkpoint, not the render; an interrupted one has no more.
            if (result.interrupted)
                throw;
            spdlog::warn("{}; the render goes on without", error.what());
        }
        written_ = Clock::now();
        write_seconds_ = seconds_since(start);
    }

private:
    const RenderOptions& options_;
    RenderCheckpoint head_;
    Clock::time_point written_ = Clock::now();
    double write_seconds_ = 0.0;
};

} // namespace

std::uint64_t predicted_render_bytes(const Scene& scene, const WavelengthPlan& plan,
                                     const RenderOptions& options) {
    const auto pixels = static_cast<std::uint64_t>(scene.film.width) *
                        static_cast<std::uint64_t>(scene.film.height);
    const auto lanes = static_cast<std::uint64_t>(plan.padded_lanes());
    const std::uint64_t rows = options.band_variance ? 4 : 3;
    const std::uint64_t film = pixels * (rows * lanes + film_statistics_per_pixel) * 4;
    const std::uint64_t image = pixels * (static_cast<std::uint64_t>(plan.film.count) + 5) * 4;
    const std::uint64_t depth = static_cast<std::uint64_t>(scene.integrator.max_depth) + 1;
    const ModelBytes models = model_bytes(scene, plan, options.model);
    const std::uint64_t vertex = sizeof(VertexRecord) + sizeof(RayRecord) + models.vertex +
                                 (has_colours(scene) ? VERTEX_COLOURS * sizeof(float) : 0) +
                                 (plan.hero > 0 ? 8 * hero_width(plan.hero) : 0);
    const std::uint64_t paths =
        options.batch_paths * (depth * vertex + models.path + lanes * 4 + sizeof(RayRecord) +
                               sizeof(HitRecord) + sizeof(PathState));
    // The film goes as the image comes, but for observers of passes, who see an image beside it; a
    // checkpoint is read as a whole.
    return film + image + (options.resume ? film : 0) + paths;
}

RenderResult render(const Scene& scene, const Device& device, const RenderOptions& options,
                    const std::function<bool(const RenderProgress&)>& progress,
                    const RenderObserver& observe) {
    const Clock::time_point start = Clock::now();
    if (options.in_double)
        check_double(device.info());
    RenderResult result;
    result.plan =
        plan_wavelengths(scene, options.bands.value_or(film_bands(scene)), options.wavelengths);
    check_memory(scene, result.plan, options);
    const SceneTables tables = prepare_tables(scene, result.plan, options);
    const Geometry geometry(scene, tables.features.textures || tables.features.reflectance_image);
    Wavefront wavefront(device, geometry, tables, result.plan,
                        {static_cast<std::uint32_t>(scene.integrator.max_depth),
                         static_cast<std::uint32_t>(scene.integrator.min_depth), options.seed,
                         options.batch_paths, options.threads, sequence_blocks(options),
                         options.on_rays},
                        result.build);
    result.setup_seconds = seconds_since(start) - result.build.seconds;

    FilmLayout layout =
        film_layout(result.plan, tables.features.band_variance, tables.features.scatter);
    layout.independent_samples = sequence_blocks(options) == 0;
    Checkpoints checkpoints(scene, device, options);
    RenderProgress state = checkpoints.resume(wavefront, result);
    const double seconds_before = state.seconds;
    double observing_seconds = 0.0;
    const Clock::time_point rendering = Clock::now();
    while (!must_stop(state, options)) {
        const std::uint32_t samples = next_pass(state, options);
        wavefront.render_pass(options.first_sample + state.samples, samples);
        state.samples += samples;
        state.seconds = seconds_before + seconds_since(rendering) - observing_seconds;
        wavefront.film().read(
            [&](FilmSums film) { estimate_error(state, film, layout, result.plan); });
        result.passes.push_back(state);
        if (observe)
            observing_seconds += seconds_of([&] {
                observe(state, [&] {
                    return resolved(wavefront, film_resolver(layout, scene, result.plan, state));
                });
            });
        result.interrupted = progress && !progress(state);
        checkpoints.after_pass(wavefront, result);
        if (result.interrupted)
            break;
    }
    finish_film(result, wavefront, film_resolver(layout, scene, result.plan, state));
    result.samples = state.samples;
    result.relmse = state.relmse;
    collect(result, wavefront, tables);
    result.total_seconds = seconds_since(start);
    return result;
}

} // namespace reradiant
