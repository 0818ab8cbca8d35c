#include "host/render/renderer.h"

#include "host/render/rendering.h"

#include <algorithm>

namespace reradiant {

namespace {

/// Samples of a pass: between passes the film is read and the stop rules are checked.
constexpr std::uint32_t samples_in_pass = 64;

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

} // namespace

RenderResult render(const Scene& scene, const Device& device, const RenderOptions& options,
                    const std::function<bool(const RenderProgress&)>& progress,
                    const RenderObserver& observe) {
    Rendering rendering(scene, device, options);
    rendering.resume();
    while (!rendering.must_stop() && !rendering.interrupted()) {
        const std::uint32_t done = rendering.state().samples;
        const std::uint32_t samples = next_pass(rendering.state(), options);
        rendering.wavefront().render_pass(options.first_sample + done, samples);
        rendering.after_pass(done + samples, observe, progress);
    }
    return rendering.finish_with_image();
}

} // namespace reradiant
