// What counts for the time that a render may take.
#include "host/render/wavefront/render_hooks.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <chrono>

namespace reradiant {
namespace {

using namespace test;
using Clock = std::chrono::steady_clock;

RenderOptions of_time(double seconds, const RenderHooks* hooks) {
    RenderOptions options;
    options.samples = 1u << 30;
    options.time_seconds = seconds;
    options.bands = grid_from_range(450, 650, 100);
    options.hooks = hooks;
    return options;
}

Scene small_scene() {
    Scene scene = plane_scene(material({layer(1.5)}, 0.5), 20.0, 16, 16);
    scene.lights = {environment(Spectrum::constant(1.0))};
    return scene;
}

} // namespace

TEST(RenderTime, WhatWentBeforeCountsWhereTheHooksSaySo) {
    const RenderHooks long_ago{.time_counts_from = Clock::now() - std::chrono::seconds(100)};
    EXPECT_EQ(render(small_scene(), device(), of_time(50.0, &long_ago)).samples, 1u)
        << "one pass there is, however little time";
    const RenderHooks none;
    EXPECT_GT(render(small_scene(), device(), of_time(0.3, &none)).samples, 2u);
}

TEST(RenderTime, PassesEndWithTheTime) {
    constexpr double seconds = 3.0;
    const RenderHooks none;
    render(small_scene(), device(), of_time(0.01, &none)); // builds the kernels
    const RenderHooks hooks{.time_counts_from = Clock::now()};
    render(small_scene(), device(), of_time(seconds, &hooks));
    const std::chrono::duration<double> taken = Clock::now() - *hooks.time_counts_from;
    EXPECT_GE(taken.count(), seconds);
    // Doubling passes alone take up to twice the time. A sample takes milliseconds; what is left is
    // for other tests on this machine.
    EXPECT_LT(taken.count(), 1.3 * seconds);
}

} // namespace reradiant
