#include "host/report/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace reradiant {

namespace {

/// A log gets its line once an estimate is worth something, and only when much is left.
constexpr double seconds_to_announcement = 5.0, shortest_announced = 30.0;

} // namespace

std::string progress_line(double share, const std::string& note, int width) {
    const double done = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
    const auto full = static_cast<std::size_t>(done * width);
    const std::string bar =
        std::string(full, '#') + std::string(static_cast<std::size_t>(width) - full, '-');
    return fmt::format("[{}] {:3.0f} % {}", bar, std::floor(100.0 * done), note);
}

std::string duration_text(double seconds) {
    if (seconds < 59.5)
        return fmt::format("{:.0f} s", std::max(seconds, 1.0));
    return seconds < 3570.0 ? fmt::format("{:.0f} min", seconds / 60.0)
                            : fmt::format("{:.1f} h", seconds / 3600.0);
}

std::optional<double> seconds_left(double seconds, double from_share, double share) {
    const double done = share - from_share;
    if (!(seconds >= 2.0) || !(done >= 0.01) || !(share < 1.0))
        return std::nullopt;
    return seconds / done * (1.0 - share);
}

ProgressBar::ProgressBar(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
    if (drawn_)
        std::fputs("\r\033[K", stderr);
}

double ProgressBar::seconds_since(Clock::time_point start) const {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool ProgressBar::is_due() const {
    if (quiet_)
        return false;
    return terminal_
               ? Clock::now() >= next_
               : !announced_ && (!first_share_ || seconds_since(first_) >= seconds_to_announcement);
}

void ProgressBar::draw(const std::string& line) {
    next_ = Clock::now() + std::chrono::milliseconds(100);
    drawn_ = true;
    fmt::print(stderr, "\r{}\033[K", line);
    std::fflush(stderr);
}

void ProgressBar::update(double share, const std::string& note) {
    if (!first_share_) {
        first_share_ = share;
        first_ = Clock::now();
    }
    if (!is_due())
        return;
    const std::optional<double> left = seconds_left(seconds_since(first_), *first_share_, share);
    if (terminal_)
        return draw(progress_line(
            share, left ? fmt::format("{}, about {} left", note, duration_text(*left)) : note));
    if (!left || *left < shortest_announced)
        return;
    announced_ = true;
    fmt::print(stderr, "{}; about {} to go\n", note, duration_text(*left));
}

void ProgressBar::update(const std::string& note) {
    if (!terminal_ || !is_due())
        return;
    const double seconds = seconds_since(made_);
    draw(seconds < 2.0 ? note : fmt::format("{}, {} so far", note, duration_text(seconds)));
}

} // namespace reradiant
