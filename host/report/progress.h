#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace reradiant {

/// A `ProgressBar` shows how far work is and how long it will take, on standard error unless
/// somebody asked for quiet. On a terminal it is a bar; elsewhere, so that logs and pipes hold no
/// control characters, it is one line early in work that takes long.
class ProgressBar {
public:
    explicit ProgressBar(bool quiet);
    ~ProgressBar(); ///< clears the line
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Shows the share done, 0 to 1, with a short note behind the bar, and redraws at most ten
    /// times a second. The time left is estimated from the first share that was told, since what an
    /// earlier run did took no time now.
    void update(double share, const std::string& note);
    /// Shows the note and the seconds since the bar was made, for work whose end nobody knows.
    void update(const std::string& note);
    /// Returns true when an update would show anything now, for shares that are expensive to find
    /// out.
    bool is_due() const;

private:
    using Clock = std::chrono::steady_clock;

    double seconds_since(Clock::time_point start) const;
    void draw(const std::string& line);

    bool quiet_, terminal_;
    bool drawn_ = false, announced_ = false;
    Clock::time_point made_ = Clock::now(), first_{}, next_{};
    std::optional<double> first_share_;
};

/// One line of the bar, without control characters: "[######----]  60 % note".
std::string progress_line(double share, const std::string& note, int width = 30);

/// "12 s", "3 min", "1.2 h"
std::string duration_text(double seconds);

/// Returns the seconds to the end of work that went from one share to another in `seconds`, or
/// nothing while that says little: before two seconds, or a hundredth of the work.
std::optional<double> seconds_left(double seconds, double from_share, double share);

} // namespace reradiant
