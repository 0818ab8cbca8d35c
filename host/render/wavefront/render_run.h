#pragma once

#include "host/geometry/geometry.h"
#include "host/render/checkpoint/checkpoint_file.h"
#include "host/render/plan/render_plan.h"
#include "host/render/tables/scene_tables.h"
#include "host/render/wavefront/wavefront.h"
#include "reradiant/render.h"

#include <chrono>
#include <functional>
#include <vector>

namespace reradiant {

/// A render that was set up: what it has, and the steps that its passes are made of.
class RenderRun {
public:
    /// Refuses what render() refuses.
    RenderRun(const Scene& scene, const Device& device, const RenderOptions& options);

    /// Goes on from the checkpoint where there is one and it is asked for. Time begins to count.
    void resume();
    const RenderProgress& state() const { return state_; }
    bool must_stop() const;
    /// Seconds of rendering until now; what observers took is left out.
    double seconds() const;
    /// Seconds that count for RenderOptions::time_seconds, set-up with them where the hooks say so;
    /// those of a resumed render count on.
    double counted_seconds() const;
    Wavefront& wavefront() { return wavefront_; }
    const RenderPlan& plan() const { return plan_; }
    /// Returns what each pixel says of where the next samples of an adaptive render go. To be asked
    /// once after each pass.
    std::vector<float> pixel_errors();

    /// The film holds so many samples now. Estimates the error where it is time to, shows the pass
    /// to the observer, and writes a checkpoint when it is time or when `goes_on`, which is asked
    /// last, says no.
    void after_pass(std::uint32_t samples, const RenderObserver& observe,
                    const std::function<bool(const RenderProgress&)>& goes_on);
    bool interrupted() const { return result_.interrupted; }
    /// Returns the result, without an image. Nothing can be rendered afterwards.
    RenderResult finish();
    /// Returns the result as `finish` does, with the image.
    RenderResult finish_with_image();

private:
    using Clock = std::chrono::steady_clock;

    bool wants_estimate(bool observed) const;
    void estimate_error();
    SpectralImage image_so_far() const;

    Clock::time_point start_ = Clock::now(), rendering_;
    const Scene& scene_;
    const RenderOptions& options_;
    RenderResult result_;
    const RenderPlan plan_;
    SceneTables tables_;
    Geometry geometry_;
    Wavefront wavefront_;
    CheckpointFile checkpoint_;
    RenderProgress state_;
    /// Of the last estimate; the first one is made of four times as many as this.
    std::uint32_t estimated_samples_ = 2;
    std::vector<float> errors_; ///< pixel_errors, where the last estimate found them too
    double seconds_before_ = 0.0, observing_seconds_ = 0.0;
};

} // namespace reradiant
