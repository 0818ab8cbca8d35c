#include "host/render/wavefront/sample_dispenser.h"

#include <algorithm>

namespace reradiant {

namespace {

/// A range of so many seconds at least costs little more than its samples, and one of so many at
/// most keeps nobody from answering an interrupt.
constexpr double shortest_range_seconds = 0.25, longest_range_seconds = 4.0;

} // namespace

SampleDispenser::SampleDispenser(const RenderOptions& options, const RenderProgress& state,
                                 int members)
    : options_(options), members_(static_cast<std::uint32_t>(members)), handed_out_(state.samples) {
}

void SampleDispenser::begin_round(double seconds, double seconds_before) {
    round_seconds_ = std::min(seconds, options_.time_seconds - seconds_before);
    seconds_before_ = seconds_before;
    round_ = std::chrono::steady_clock::now();
}

double SampleDispenser::seconds_in_round() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - round_).count();
}

std::uint32_t SampleDispenser::size_for(const TeamReport& report, double seconds_left) const {
    const std::uint32_t left = options_.samples - handed_out_;
    if (report.done.count == 0)
        return std::min(left, 2u);
    const double by_now = seconds_before_ + seconds_in_round();
    const double wanted = std::min(
        std::clamp(by_now / 16.0, shortest_range_seconds, longest_range_seconds), seconds_left);
    const double rate = static_cast<double>(report.done.count) / std::max(report.seconds, 1e-6);
    const double fair =
        static_cast<double>(left) / (2.0 * members_); // half of what each can expect
    const auto pairs = static_cast<std::uint32_t>(std::min(rate * wanted, fair) / 2.0);
    return std::min(left, 2u * std::max(1u, pairs));
}

TeamTask SampleDispenser::next(const TeamReport& report) {
    if (report.interrupted)
        interrupted_ = true;
    const double seconds_left = round_seconds_ - seconds_in_round();
    const std::uint32_t first = handed_out_;
    const bool begun = first > 0; // one pass there is, however little time
    if (first >= options_.samples || (begun && (interrupted_ || seconds_left <= 0.0)))
        return {};
    const std::uint32_t count = size_for(report, std::max(seconds_left, 0.0));
    handed_out_ = first + count;
    return {first, count};
}

} // namespace reradiant
