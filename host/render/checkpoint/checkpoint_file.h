#pragma once

#include "host/render/checkpoint/checkpoint.h"
#include "host/render/wavefront/wavefront.h"

#include <chrono>

namespace reradiant {

/// The checkpoint file of one render, where its options name one.
class CheckpointFile {
public:
    CheckpointFile(const Scene& scene, const Device& device, const RenderOptions& options);

    /// The state to go on from: that of the file where there is one and it is asked for.
    RenderProgress resume(Wavefront& wavefront, RenderResult& result) const;
    /// Writes one when it is time, and for an interrupted render. Keeps the share of time that goes
    /// into writing below a tenth. The result's passes end with the state of the film.
    void after_pass(const Wavefront& wavefront, const RenderResult& result);

private:
    using Clock = std::chrono::steady_clock;

    const RenderOptions& options_;
    RenderCheckpoint head_;
    Clock::time_point written_ = Clock::now();
    double write_seconds_ = 0.0;
};

} // namespace reradiant
