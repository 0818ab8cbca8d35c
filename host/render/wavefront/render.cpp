#include "reradiant/render.h"

#include "host/render/wavefront/adaptive.h"
#include "host/render/wavefront/render_run.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

/// Samples of a pass: between passes the film is read and the stop rules are checked.
constexpr std::uint32_t samples_in_pass = 64;

/// Doubling passes: the first ones show and estimate early, later ones cost little to stop, and
/// take a sixteenth of what is done, so that their number stays small.
std::uint32_t usual_pass(std::uint32_t done) {
    return std::max(std::clamp<std::uint32_t>(done, 1, samples_in_pass), done / 16);
}

/// A usual pass, but not far beyond where the estimated error is likely to be the one that is asked
/// for. Pairs, so that both halves stay equal.
std::uint32_t wanted_pass(const RenderProgress& state, const RenderOptions& options) {
    const std::uint32_t usual = usual_pass(state.samples);
    if (!(options.relmse > 0.0 && std::isfinite(state.relmse)))
        return usual;
    constexpr double slope = 1.2; // of the error of a low-discrepancy sequence
    const double missing =
        state.samples * (std::pow(state.relmse / options.relmse, 1.0 / slope) - 1.0);
    // adaptive samples bring several times what even ones do at first
    const double most = std::max(options.adaptive ? missing / 3.0 : missing, state.samples / 8.0);
    return most < usual ? 2 * std::max(1u, static_cast<std::uint32_t>(std::ceil(0.5 * most)))
                        : usual;
}

/// A pass of so many samples, or of those that so many seconds suffice for at the rate so far.
std::uint32_t pass_within(double seconds, std::uint32_t size, const RenderProgress& state) {
    const double affordable = state.samples * seconds / std::max(state.seconds, 1e-9);
    return state.samples > 0 && affordable < size
               ? std::max(1u, static_cast<std::uint32_t>(std::max(affordable, 0.0)))
               : size;
}

/// A wanted pass, but none longer than the time that is left.
std::uint32_t timely_pass(const RenderRun& rendering, const RenderOptions& options) {
    const RenderProgress& state = rendering.state();
    return pass_within(options.time_seconds - rendering.counted_seconds(),
                       wanted_pass(state, options), state);
}

/// A timely pass, but none longer than the time between two checkpoints.
std::uint32_t next_pass(const RenderRun& rendering, const RenderOptions& options) {
    const RenderProgress& state = rendering.state();
    std::uint32_t size = timely_pass(rendering, options);
    if (!options.checkpoint.empty())
        size = pass_within(options.checkpoint_seconds, size, state);
    return std::min(size, options.samples - state.samples);
}

/// Returns where the samples of the next pass go, which is as large as a timely one. Without a
/// limit of time it does not depend on how long earlier passes took, so that a resumed render takes
/// the same samples.
std::vector<AdaptiveGroup> adaptive_pass(RenderRun& rendering, const Scene& scene,
                                         const RenderOptions& options) {
    const std::uint64_t pixels = static_cast<std::uint64_t>(scene.film.width) *
                                 static_cast<std::uint64_t>(scene.film.height);
    const std::vector<float> errors = rendering.pixel_errors();
    std::vector<AdaptiveGroup> groups;
    rendering.wavefront().film().read([&](FilmSums film) {
        const std::uint64_t left = pixels * options.samples - samples_of(film);
        const std::uint64_t timely = pixels * timely_pass(rendering, options);
        groups = adaptive_groups(film, errors, scene.film.width, scene.film.height,
                                 options.first_sample, std::min(timely, left), left);
    });
    return groups;
}

/// Renders one pass and returns the samples that the pixels have on the average.
std::uint32_t render_pass(RenderRun& rendering, const Scene& scene, const RenderOptions& options) {
    const std::uint32_t done = rendering.state().samples;
    const std::uint32_t even =
        options.adaptive ? samples_before_adapting(rendering.plan().wavelengths) : options.samples;
    if (done < even) {
        const std::uint32_t samples = std::min(next_pass(rendering, options), even - done);
        rendering.wavefront().render_pass(options.first_sample + done, samples);
        return done + samples;
    }
    const std::vector<AdaptiveGroup> groups = adaptive_pass(rendering, scene, options);
    for (const AdaptiveGroup& group : groups)
        rendering.wavefront().render_pass(group.pixels, group.samples);
    std::uint64_t taken = 0;
    rendering.wavefront().film().read([&](FilmSums film) { taken = samples_of(film); });
    return static_cast<std::uint32_t>(taken / (static_cast<std::uint64_t>(scene.film.width) *
                                               static_cast<std::uint64_t>(scene.film.height)));
}

} // namespace

RenderResult render(const Scene& scene, const Device& device, const RenderOptions& options,
                    const std::function<bool(const RenderProgress&)>& progress,
                    const RenderObserver& observe) {
    RenderRun rendering(scene, device, options);
    rendering.resume();
    while (!rendering.must_stop() && !rendering.interrupted()) {
        const std::uint64_t paths = rendering.wavefront().statistics().paths;
        const std::uint32_t samples = render_pass(rendering, scene, options);
        if (rendering.wavefront().statistics().paths == paths)
            break; // no tile of an adaptive render fits what is left
        rendering.after_pass(samples, observe, progress);
    }
    return rendering.finish_with_image();
}

} // namespace reradiant
