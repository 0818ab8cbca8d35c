#pragma once

#include "host/render/renderer.h"
#include "host/render/wavefront.h"

#include <cstdint>
#include <vector>

namespace reradiant {

/// Decides which samples each pass of a render takes.
class SamplingSchedule {
public:
    SamplingSchedule(const Scene& scene, const RenderOptions& options, const WavelengthPlan& plan,
                     const FilmLayout& layout);

    bool must_stop(const RenderProgress& state) const;
    /// Renders the next pass and counts it in `state`. False when no further pass fits what is to
    /// be rendered.
    bool render_pass(Wavefront& wavefront, RenderProgress& state);
    /// Estimates the error after a pass.
    void estimate_error(const Wavefront& wavefront, RenderProgress& state);

private:
    bool render_adaptive_pass(Wavefront& wavefront, RenderProgress& state);

    const RenderOptions& options_;
    const FilmLayout& layout_;
    int width_, height_, bands_;
    std::uint32_t first_adaptive_; ///< samples of every pixel before a pass chooses pixels
    std::vector<float> errors_;    ///< of pixels, of the last estimate; of adaptive renders only
};

} // namespace reradiant
