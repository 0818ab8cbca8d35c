#include "host/render/film/likely_value.h"
#include "reradiant/scene_file.h"
#include "tests/render/test_scenes.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

namespace reradiant {
namespace {

using namespace test;

Scene bare() {
    Scene scene = sphere_scene(fluorescent({}, shifted_matrix()), 16, 16);
    scene.lights = {RectangleLight{{2, 4, 3}, {1, 0, 0}, {0, 0, 1}, Spectrum::constant(5.0)}};
    return scene;
}

/// Samples its own highlight.
Scene layered() {
    Scene scene = bare();
    scene.materials =
        sphere_scene(fluorescent({layer(1.5, 0.3)}, shifted_matrix()), 1, 1).materials;
    scene.lights.push_back(environment(Spectrum::constant(0.2)));
    return scene;
}

/// Light that goes to and fro between surfaces and is re-radiated there.
Scene bounces() {
    Scene scene = bare();
    scene.shapes.push_back({RectangleShape{{0, -1, 0}, {0, 0, 8}, {8, 0, 0}}, 0});
    scene.shapes.push_back({RectangleShape{{-1.2, 0, 0}, {0, 8, 0}, {0, 0, 8}}, 0});
    return scene;
}

RenderResult rendered(const Scene& scene, std::uint32_t samples, std::uint32_t seed) {
    RenderOptions options;
    options.samples = samples;
    options.seed = seed;
    options.bands = grid_from_range(400, 700, 50);
    return render(scene, device(), options);
}

/// Share of the renders whose 95 % interval holds their error against a reference. Prints beside it
/// how many errors lie above, and how far the estimates are off on the average.
double covered_share(const Scene& scene, const SpectralImage& reference, std::uint32_t samples,
                     int renders) {
    int covered = 0, above = 0;
    double log_width = 0.0, estimates = 0.0, errors = 0.0;
    for (int seed = 0; seed < renders; ++seed) {
        const RenderResult result = rendered(scene, samples, static_cast<std::uint32_t>(seed));
        const RenderProgress& state = result.passes.back();
        const double error = compare_images(result.image, reference).relmse;
        covered += state.relmse_low <= error && error <= state.relmse_high;
        above += error > state.relmse_high;
        estimates += state.relmse;
        errors += error;
        log_width += std::log(state.relmse_high / state.relmse_low) / renders;
    }
    std::printf(
        "%3u samples: covers %d of %d, %d errors above, high / low %.2f, estimates / errors "
        "%.3f\n",
        samples, covered, renders, above, std::exp(log_width), estimates / errors);
    return static_cast<double>(covered) / renders;
}

/// 92 to 98 % over 1000 renders each in a full run. A normal run has 60 renders, whose share
/// scatters by 2.8 %: Sidak's bound of one comparison is allowed beyond, which still fails an
/// interval that is half as wide (67 %). The reference adds its own error, 1 % of the renders'.
void expect_covered(const Scene& scene) {
    const bool full = test::is_full_run();
    const int renders = full ? 1000 : 60;
    const double slack = full ? 0.0 : test::sidak_bound(1) * std::sqrt(0.95 * 0.05 / renders);
    const SpectralImage reference = rendered(scene, full ? 8192 : 3200, 100000).image;
    for (const std::uint32_t samples : full ? std::vector{8u, 32u, 80u} : std::vector{32u}) {
        const double share = covered_share(scene, reference, samples, renders);
        EXPECT_GE(share, 0.92 - slack) << samples << " samples";
        EXPECT_LE(share, 0.98 + slack) << samples << " samples";
    }
}

TEST(ErrorInterval, CoversTheErrorOfABareMaterial) {
    expect_covered(bare());
}

TEST(ErrorInterval, CoversTheErrorOfALayer) {
    expect_covered(layered());
}

TEST(ErrorInterval, CoversTheErrorOfBounces) {
    expect_covered(bounces());
}

/// Median of estimates over true errors, by eleven seeds, of a sample beneath a smooth layer that
/// is lit by a line. In that line's band its highlights are far brighter than what is around them,
/// and in small their edges hold much of the error.
double median_ratio_at_highlights(std::uint32_t samples) {
    Scene scene = load_scene(std::string(RERADIANT_SOURCE_DIR) +
                             "/tools/examples/fluorescent-smooth-405.toml");
    scene.film.width = 74;
    scene.film.height = 31;
    RenderOptions options;
    options.samples = 4096;
    options.seed = 1000000;
    const SpectralImage reference = render(scene, device(), options).image;
    options.samples = samples;
    std::vector<double> ratios;
    for (options.seed = 0; options.seed < 11; ++options.seed) {
        const RenderResult result = render(scene, device(), options);
        ratios.push_back(result.relmse / compare_images(result.image, reference).relmse);
    }
    std::sort(ratios.begin(), ratios.end());
    return ratios[5];
}

/// A pixel at an edge of which one sample saw the highlight was judged by the dark beside it: the
/// estimate was more than a hundred times too large here. Single renders scatter by some 20 %, and
/// what a truth may be is guessed, hence the wide bounds.
TEST(ErrorEstimate, EdgesOfHighlightsAreNotJudgedByTheDarkBesideThem) {
    const double median = median_ratio_at_highlights(32);
    EXPECT_GT(median, 0.6);
    EXPECT_LT(median, 1.6);
}

TEST(LikelyValue, FireflyIsJudgedByItsNeighbours) {
    const std::vector<SeenValue> flat(8, {1.0, 0.01});
    // 100 in one sample of one half: the truth is near 1
    EXPECT_NEAR(expected_inverse_square({51.0, 50.0}, flat, 0.01), 1.0 / 1.01, 0.1);
}

TEST(LikelyValue, PixelOfAnEdgeIsJudgedByItself) {
    std::vector<SeenValue> edge(8, {0.0, 0.0});
    edge[0] = edge[1] = edge[2] = {100.0, 1.0};
    const double weight = expected_inverse_square({10.0, 10.0}, edge, 1e-2);
    EXPECT_GT(weight, 0.5 / 100.0);
    EXPECT_LT(weight, 5.0 / 100.0);
}

TEST(LikelyValue, NoiseIsTakenOutOfWhatNeighboursShare) {
    const std::vector<SeenValue> noisy{{0.8, 0.2}, {1.2, 0.2}, {0.9, 0.2}, {1.1, 0.2}};
    EXPECT_NEAR(expected_inverse_square({1.3, 0.4}, noisy, 0.0), 1.0, 1e-12);
}

TEST(LikelyValue, AloneAPixelIsItsOwnTruth) {
    EXPECT_EQ(expected_inverse_square({2.0, 2.0}, {}, 1.0), 0.2);
    EXPECT_EQ(expected_inverse_square({0.0, 0.0}, {}, 0.0), 0.0);
}

TEST(ErrorInterval, OnePixelHasAnEstimateButNoInterval) {
    Scene scene = bare();
    scene.film.width = scene.film.height = 1;
    const RenderProgress state = rendered(scene, 16, 0).passes.back();
    EXPECT_TRUE(std::isfinite(state.relmse));
    EXPECT_EQ(state.relmse_low, 0.0);
    EXPECT_TRUE(std::isinf(state.relmse_high));
}

TEST(ErrorInterval, ObserversSeeTheImageSoFarAndTheirTimeDoesNotCount) {
    const Scene scene = bare();
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

/// Passes that double would go to half the error that was asked for on the average. A single stop
/// may: the error of a sequence falls in steps, by half from 24 to 32 samples.
TEST(StopAtError, LittleIsRenderedBeyondIt) {
    Scene scene = bare();
    scene.film.width = scene.film.height = 64; // the estimate scatters little
    double ratios = 0.0;
    int renders = 0;
    for (const double wanted : {0.7e-3, 0.35e-3, 0.18e-3})
        for (const bool adaptive : {false, true})
            for (std::uint32_t seed = 0; seed < 3; ++seed) {
                RenderOptions options;
                options.samples = 100000;
                options.relmse = wanted;
                options.seed = seed;
                options.adaptive = adaptive;
                options.bands = grid_from_range(400, 700, 50);
                const RenderResult result = render(scene, device(), options);
                EXPECT_LE(result.relmse, wanted);
                EXPECT_GT(result.relmse, 0.4 * wanted) << wanted << ' ' << adaptive << ' ' << seed;
                ratios += result.relmse / wanted;
                ++renders;
            }
    EXPECT_GT(ratios / renders, 0.75);
}

TEST(ErrorInterval, ShortPassesAtTheBeginningGoWithoutAnEstimate) {
    const RenderResult result = rendered(bare(), 32, 0);
    std::vector<std::uint32_t> estimated;
    for (const RenderProgress& pass : result.passes)
        if (std::isfinite(pass.relmse))
            estimated.push_back(pass.samples);
    EXPECT_EQ(estimated, (std::vector<std::uint32_t>{8, 32}));
    EXPECT_EQ(result.relmse, result.passes.back().relmse);
}

} // namespace
} // namespace reradiant
