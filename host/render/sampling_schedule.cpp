#include "host/render/sampling_schedule.h"

#include "host/render/adaptive.h"

#include <algorithm>
#include <limits>

namespace reradiant {

namespace {

constexpr std::uint32_t samples_in_pass = 64;

/// Doubling passes: the first ones show and estimate early, later ones cost little to stop, and
/// take a sixteenth of what is done, so that their number stays small.
std::uint32_t usual_pass(std::uint32_t done) {
    return std::max(std::clamp<std::uint32_t>(done, 1, samples_in_pass), done / 16);
}

/// A usual pass, but none longer than the time between two checkpoints.
std::uint32_t next_pass(const RenderProgress& state, const RenderOptions& options) {
    const std::uint32_t done = state.samples;
    std::uint32_t size = usual_pass(done);
    const double affordable = done * options.checkpoint_seconds / std::max(state.seconds, 1e-9);
    if (!options.checkpoint.empty() && done > 0 && affordable < size)
        size = std::max(1u, static_cast<std::uint32_t>(affordable));
    return std::min(size, options.samples - done);
}

std::uint64_t samples_of(FilmSums film) {
    std::uint64_t samples = 0;
    for (const FilmStrip& strip : film)
        for (std::size_t pixel = 0; pixel < strip.pixels(); ++pixel)
            samples += strip.samples(pixel);
    return samples;
}

} // namespace

SamplingSchedule::SamplingSchedule(const Scene& scene, const RenderOptions& options,
                                   const WavelengthPlan& plan, const FilmLayout& layout)
    : options_(options), layout_(layout), width_(scene.film.width), height_(scene.film.height),
      bands_(plan.film.count),
      first_adaptive_(options.adaptive ? samples_before_adapting(plan)
                                       : std::numeric_limits<std::uint32_t>::max()) {}

bool SamplingSchedule::must_stop(const RenderProgress& state) const {
    return state.samples >= options_.samples || state.seconds >= options_.time_seconds ||
           (options_.relmse > 0.0 && state.relmse <= options_.relmse);
}

bool SamplingSchedule::render_pass(Wavefront& wavefront, RenderProgress& state) {
    if (state.samples >= first_adaptive_)
        return render_adaptive_pass(wavefront, state);
    const std::uint32_t samples =
        std::min(next_pass(state, options_), first_adaptive_ - state.samples);
    wavefront.render_pass(options_.first_sample + state.samples, samples);
    state.samples += samples;
    return true;
}

/// Passes do not depend on how long earlier ones took, so that a resumed render takes the same.
bool SamplingSchedule::render_adaptive_pass(Wavefront& wavefront, RenderProgress& state) {
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
    std::uint64_t taken = 0;
    std::vector<AdaptiveGroup> groups;
    wavefront.film().read([&](FilmSums film) {
        if (errors_.empty()) // of a resumed render
            estimated_relmse(film, layout_, bands_, &errors_);
        taken = samples_of(film);
        const std::uint64_t left = pixels * options_.samples - taken;
        groups = adaptive_groups(film, errors_, width_, height_, options_.first_sample,
                                 std::min(pixels * usual_pass(state.samples), left), left);
    });
    for (const AdaptiveGroup& group : groups) {
        wavefront.render_pass(group.pixels, group.samples);
        taken += group.samples * group.pixels.size();
    }
    state.samples = static_cast<std::uint32_t>(taken / pixels);
    return !groups.empty();
}

void SamplingSchedule::estimate_error(const Wavefront& wavefront, RenderProgress& state) {
    RelmseEstimate estimate;
    wavefront.film().read([&](FilmSums film) {
        estimate = estimated_relmse(film, layout_, bands_, options_.adaptive ? &errors_ : nullptr);
    });
    state.relmse = estimate.value;
    state.relmse_low = estimate.low;
    state.relmse_high = estimate.high;
}

} // namespace reradiant
