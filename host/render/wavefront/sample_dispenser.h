#pragma once

#include "host/base/team.h"
#include "reradiant/render.h"

#include <atomic>
#include <chrono>
#include <cstdint>

namespace reradiant {

/// Hands the samples of one render out to a team, in order and without gaps. Ranges have even
/// lengths but for the last, so that a part holds as many even as odd samples; they take as long as
/// messages are cheap beside, and become shorter towards the end, so that nobody waits long.
class SampleDispenser {
public:
    /// Goes on behind the samples of `state`.
    SampleDispenser(const RenderOptions& options, const RenderProgress& state, int members);

    /// A round lasts so many seconds; those of the render before it.
    void begin_round(double seconds, double seconds_before);
    /// Returns the next range of the samples to come; an empty one when the round is over.
    TeamTask next(const TeamReport& report);
    std::uint32_t handed_out() const { return handed_out_; }
    bool interrupted() const { return interrupted_; }

private:
    double seconds_in_round() const;
    std::uint32_t size_for(const TeamReport& report, double seconds_left) const;

    const RenderOptions& options_;
    std::uint32_t members_;
    std::atomic<std::uint32_t> handed_out_;
    std::atomic<bool> interrupted_ = false;
    double round_seconds_ = 0.0, seconds_before_ = 0.0;
    std::chrono::steady_clock::time_point round_ = std::chrono::steady_clock::now();
};

} // namespace reradiant
