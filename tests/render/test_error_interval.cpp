#include "tests/full_run.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <thread>

namespace reradiant {
namespace {

using namespace test;

struct Case {
    const char* name;
    Scene scene;
};

/// What noise comes from: direct light alone, a layer that samples its own highlight, and light
/// that bounces between surfaces and is re-radiated there.
std::vector<Case> cases() {
    const Light lamp = RectangleLight{{2, 4, 3}, {1, 0, 0}, {0, 0, 1}, Spectrum::constant(5.0)};
    Scene bare = sphere_scene(fluorescent({}, shifted_matrix()), 16, 16);
    bare.lights = {lamp};
    Scene layered = sphere_scene(fluorescent({layer(1.5, 0.3)}, shifted_matrix()), 16, 16);
    layered.lights = {lamp, environment(Spectrum::constant(0.2))};
    Scene bounces = bare;
    bounces.shapes.push_back({RectangleShape{{0, -1, 0}, {0, 0, 8}, {8, 0, 0}}, 0});
    bounces.shapes.push_back({RectangleShape{{-1.2, 0, 0}, {0, 8, 0}, {0, 0, 8}}, 0});
    return {{"bare", bare}, {"layered", layered}, {"bounces", bounces}};
}

RenderResult rendered(const Scene& scene, std::uint32_t samples, std::uint32_t seed) {
    RenderOptions options;
    options.samples = samples;
    options.seed = seed;
    options.bands = grid_from_range(400, 700, 50);
    return render(scene, device(), options);
}

/// Counts the renders whose 95 % interval holds their error against a reference.
double covered_share(const Case& one, const SpectralImage& reference, std::uint32_t samples,
                     int renders) {
    int covered = 0;
    double log_width = 0.0;
    for (int seed = 0; seed < renders; ++seed) {
        const RenderResult result = rendered(one.scene, samples, static_cast<std::uint32_t>(seed));
        const RenderProgress& state = result.passes.back();
        const double error = compare_images(result.image, reference).relmse;
        covered += state.relmse_low <= error && error <= state.relmse_high;
        log_width += std::log(state.relmse_high / state.relmse_low) / renders;
    }
    const double share = static_cast<double>(covered) / renders;
    std::printf("%-8s %3u samples: %.1f %% of %d, high / low %.2f\n", one.name, samples,
                100.0 * share, renders, std::exp(log_width));
    return share;
}

/// 92 to 98 % over 1000 renders each in a full run. A normal run has 60 renders of one case, whose
/// share scatters by 2.8 %: Sidak's bound of one comparison is allowed beyond, which still fails an
/// interval that is half as wide (67 %). The reference adds its own error, 1 % of the renders'.
TEST(ErrorInterval, NinetyFivePercentIntervalCoversTheErrorAgainstAReference) {
    const bool full = is_full_run();
    const int renders = full ? 1000 : 60;
    const double slack = full ? 0.0 : sidak_sigmas(1) * std::sqrt(0.95 * 0.05 / renders);
    for (const Case& one : cases()) {
        if (!full && std::string_view(one.name) != "layered")
            continue;
        const SpectralImage reference = rendered(one.scene, full ? 8192 : 3200, 100000).image;
        for (const std::uint32_t samples : full ? std::vector{8u, 32u, 80u} : std::vector{32u}) {
            const double share = covered_share(one, reference, samples, renders);
            EXPECT_GE(share, 0.92 - slack) << one.name << ", " << samples << " samples";
            EXPECT_LE(share, 0.98 + slack) << one.name << ", " << samples << " samples";
        }
    }
}

TEST(ErrorInterval, OnePixelHasAnEstimateButNoInterval) {
    Scene scene = cases()[0].scene;
    scene.film.width = scene.film.height = 1;
    const RenderProgress state = rendered(scene, 16, 0).passes.back();
    EXPECT_TRUE(std::isfinite(state.relmse));
    EXPECT_EQ(state.relmse_low, 0.0);
    EXPECT_TRUE(std::isinf(state.relmse_high));
}

TEST(ErrorInterval, ObserversSeeTheImageSoFarAndTheirTimeDoesNotCount) {
    const Scene scene = cases()[0].scene;
    RenderOptions options;
    options.samples = 4;
    std::vector<SpectralImage> images;
    const RenderResult result =
        render(scene, device(), options, {}, [&](const RenderProgress& state, const auto& image) {
            images.push_back(image());
            EXPECT_EQ(images.back().sample_count[0], static_cast<float>(state.samples));
            std::this_thread::sleep_for(std::chrono::milliseconds(700));
        });
    ASSERT_EQ(images.size(), 3u) << "passes of 1, 1 and 2 samples";
    EXPECT_EQ(images.back().values, result.image.values);
    EXPECT_NE(images.front().values, result.image.values);
    // Two waits lie before the last pass' time.
    EXPECT_LT(result.passes.back().seconds, result.total_seconds - 2.0);
}

} // namespace
} // namespace reradiant
