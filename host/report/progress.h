#pragma once

#include <chrono>
#include <string>

namespace reradiant {

/// A progress bar on standard error: only when that is a terminal and nobody asked for quiet,
/// so that logs and pipes hold no control characters.
class ProgressBar {
public:
    explicit ProgressBar(bool quiet);
    ~ProgressBar(); ///< clears the line
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Share done, 0 to 1, with a short note behind the bar. Redraws at most ten times a second.
    void update(double share, const std::string& note);

private:
    bool visible_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point next_{};
};

/// One line of the bar, without control characters: "[######----]  60 % note".
std::string progress_line(double share, const std::string& note, int width = 30);

} // namespace reradiant
