#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace reradiant {
namespace {

using namespace test;

Scene noisy_scene() {
    Scene scene = sphere_scene(material({layer(1.5, 0.3)}, 0.6), 24, 24);
    scene.lights = {RectangleLight{{2, 4, 3}, {1, 0, 0}, {0, 0, 1}, Spectrum::constant(5.0)},
                    environment(Spectrum::constant(0.2))};
    return scene;
}

RenderResult rendered(std::uint32_t samples, std::uint32_t seed, bool variance = false) {
    RenderOptions options;
    options.samples = samples;
    options.seed = seed;
    options.bands = grid_from_range(400, 700, 50);
    options.band_variance = variance;
    return render(noisy_scene(), device(), options);
}

TEST(FilmSums, EstimatedRelmseIsThatAgainstAReference) {
    const RenderResult reference = rendered(8192, 1000);
    constexpr int renders = 32;
    double measured = 0.0, difference = 0.0, squares = 0.0;
    for (std::uint32_t seed = 0; seed < renders; ++seed) {
        const RenderResult result = rendered(16, seed);
        const double against_reference = compare_images(result.image, reference.image).relmse;
        const double d = result.relmse - against_reference;
        measured += against_reference / renders;
        difference += d / renders;
        squares += d * d / renders;
    }
    const double standard_error = std::sqrt((squares - difference * difference) / (renders - 1));
    // 5 standard errors between renders; 2 % for the reference's own error and for the mean of
    // 16 samples that stands in the estimate's denominator.
    EXPECT_NEAR(difference, 0.0, 5.0 * standard_error + 0.02 * measured);
    EXPECT_LT(standard_error, 0.1 * measured) << "too noisy to say anything";
}

TEST(FilmSums, ErrorFallsAsTheInverseSquareRootOfSamples) {
    const RenderResult reference = rendered(16384, 1000);
    double previous = 0.0;
    for (const std::uint32_t samples : {16u, 64u, 256u}) {
        double error = 0.0;
        for (std::uint32_t seed = 0; seed < 8; ++seed)
            error += compare_images(rendered(samples, seed).image, reference.image).rmse / 8.0;
        if (previous > 0.0) {
            EXPECT_NEAR(std::log(error / previous) / std::log(4.0), -0.5, 0.05);
        }
        previous = error;
    }
}

TEST(FilmSums, VariancePerBandPredictsTheSpreadBetweenRenders) {
    double predicted = 0.0, spread = 0.0;
    constexpr std::uint32_t pairs = 12;
    for (std::uint32_t pair = 0; pair < pairs; ++pair) {
        const RenderResult one = rendered(64, 2 * pair, true);
        const RenderResult other = rendered(64, 2 * pair + 1, true);
        ASSERT_EQ(one.image.variance_bands.size(), one.image.values.size());
        for (std::size_t i = 0; i < one.image.values.size(); ++i) {
            const double d = static_cast<double>(one.image.values[i]) -
                             static_cast<double>(other.image.values[i]);
            spread += 0.5 * d * d / pairs;
            predicted += static_cast<double>(one.image.variance_bands[i]) / pairs;
        }
    }
    EXPECT_NEAR(spread, predicted, 0.1 * predicted);
}

TEST(FilmSums, EstimateKnowsWhichHalfHasOneSampleMore) {
    const auto relmse = [](std::uint32_t first, std::uint32_t samples) {
        RenderOptions options;
        options.first_sample = first;
        options.samples = samples;
        options.bands = grid_from_range(400, 700, 50);
        return render(noisy_scene(), device(), options).relmse;
    };
    const double even = relmse(0, 64);
    EXPECT_NEAR(relmse(0, 63), even, 0.2 * even);
    EXPECT_NEAR(relmse(1, 63), even, 0.2 * even);
}

TEST(FilmSums, MemoryLimitRefusesBeforeWorkStarts) {
    RenderOptions options;
    options.memory_limit_bytes = 1000;
    EXPECT_THROW(render(noisy_scene(), device(), options), Error);
}

} // namespace
} // namespace reradiant
