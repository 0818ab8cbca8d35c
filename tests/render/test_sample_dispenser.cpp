#include "host/render/wavefront/sample_dispenser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace reradiant {

namespace {

constexpr double for_ever = std::numeric_limits<double>::infinity();

/// A member that says that samples take it no time worth speaking of.
TeamReport fast(const TeamTask& done) {
    return {done, 1e-6 * static_cast<double>(done.count)};
}

RenderOptions of_samples(std::uint32_t samples) {
    RenderOptions options;
    options.samples = samples;
    return options;
}

} // namespace

TEST(SampleDispenser, HandsOutEverySampleOnceInEvenRangesThatShrink) {
    const RenderOptions options = of_samples(100001);
    RenderProgress resumed;
    resumed.samples = 7;
    SampleDispenser dispenser(options, resumed, 4);
    dispenser.begin_round(for_ever, 0.0);
    std::uint64_t end = 7, largest = 0, last = 0;
    for (TeamTask task = dispenser.next({}); task.count > 0; task = dispenser.next(fast(task))) {
        EXPECT_EQ(task.first, end);
        end = task.first + task.count;
        if (end < options.samples) {
            EXPECT_EQ(task.count % 2, 0u);
        }
        largest = std::max(largest, task.count);
        last = task.count;
    }
    EXPECT_EQ(end, options.samples);
    EXPECT_EQ(dispenser.handed_out(), options.samples);
    EXPECT_LE(largest, 100001u / 8u) << "others wait for nobody's whole share";
    EXPECT_LE(last, 2u);
}

TEST(SampleDispenser, RoundThatIsOverHasNoMoreButTheFirstPassThereIsAlways) {
    const RenderOptions options = of_samples(1000);
    SampleDispenser dispenser(options, {}, 2);
    dispenser.begin_round(0.0, 0.0);
    const TeamTask first = dispenser.next({});
    EXPECT_GT(first.count, 0u);
    EXPECT_EQ(dispenser.next(fast(first)).count, 0u);
    dispenser.begin_round(for_ever, 1.0);
    EXPECT_GT(dispenser.next(fast(first)).count, 0u);
}

TEST(SampleDispenser, TimeEndsTheRoundAndAnInterruptionAllOfIt) {
    RenderOptions options = of_samples(1000);
    options.time_seconds = 5.0;
    SampleDispenser dispenser(options, {}, 2);
    dispenser.begin_round(for_ever, 1.0);
    TeamTask task = dispenser.next({});
    TeamReport report = fast(task);
    report.interrupted = true;
    EXPECT_EQ(dispenser.next(report).count, 0u);
    EXPECT_TRUE(dispenser.interrupted());
    SampleDispenser late(options, {}, 2);
    late.begin_round(for_ever, 1.0);
    task = late.next({});
    late.begin_round(for_ever, 5.0);
    EXPECT_EQ(late.next(fast(task)).count, 0u);
}

} // namespace reradiant
