#include "host/report/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace reradiant {

std::string progress_line(double share, const std::string& note, int width) {
    const double done = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
    const auto full = static_cast<std::size_t>(done * width);
    const std::string bar =
        std::string(full, '#') + std::string(static_cast<std::size_t>(width) - full, '-');
    return fmt::format("[{}] {:3.0f} % {}", bar, std::floor(100.0 * done), note);
}

ProgressBar::ProgressBar(bool quiet) : visible_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
    if (drawn_)
        std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double share, const std::string& note) {
    const auto now = std::chrono::steady_clock::now();
    if (!visible_ || now < next_)
        return;
    next_ = now + std::chrono::milliseconds(100);
    drawn_ = true;
    fmt::print(stderr, "\r{}\033[K", progress_line(share, note));
    std::fflush(stderr);
}

} // namespace reradiant
