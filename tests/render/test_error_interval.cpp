#include "tests/full_run.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

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

/// The share of renders whose 95 % interval holds their error against a reference must be 92 to
/// 98 %. With few renders the share itself scatters: sidak_sigmas binomial standard deviations at
/// the nearer bound are allowed beyond. The reference adds its own error, below 1 % of the
/// renders' for its sample count.
TEST(ErrorInterval, NinetyFivePercentIntervalCoversTheErrorAgainstAReference) {
    const int renders = is_full_run() ? 1000 : 60;
    const double slack = is_full_run() ? 0.0 : sidak_sigmas(6) * std::sqrt(0.95 * 0.05 / renders);
    for (const Case& one : cases()) {
        const SpectralImage reference = rendered(one.scene, 1u << 13, 100000).image;
        for (const std::uint32_t samples : {8u, 64u}) {
            int covered = 0;
            double width = 0.0;
            for (int seed = 0; seed < renders; ++seed) {
                const RenderResult result =
                    rendered(one.scene, samples, static_cast<std::uint32_t>(seed));
                const RenderProgress& state = result.passes.back();
                const double error = compare_images(result.image, reference).relmse;
                covered += state.relmse_low <= error && error <= state.relmse_high;
                width += std::log(state.relmse_high / state.relmse_low) / renders;
            }
            const double share = static_cast<double>(covered) / renders;
            std::printf("%-8s %3u samples: %.1f %% of %d, high/low %.2f\n", one.name, samples,
                        100.0 * share, renders, std::exp(width));
            EXPECT_GE(share, 0.92 - slack) << one.name << ", " << samples << " samples";
            EXPECT_LE(share, 0.98 + slack) << one.name << ", " << samples << " samples";
        }
    }
}

} // namespace
} // namespace reradiant
