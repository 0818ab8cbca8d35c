// Adaptive sampling: where the samples go, that the image stays right, and what it gains.
#include "host/render/film/error_estimate.h"
#include "host/render/wavefront/adaptive.h"
#include "tests/render/test_scenes.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <numeric>

namespace reradiant {
namespace {

using namespace test;

/// 20 x 12 pixels of 16 samples each; tiles of 8 x 8, those at the right and lower edges cut.
class SmallFilm {
public:
    static constexpr int width = 20, height = 12;

    SmallFilm() : statistics_(pixels * film_statistics_per_pixel), errors(pixels, 1e-3f) {
        for (std::size_t pixel = 0; pixel < pixels; ++pixel)
            set_samples(pixel, 16);
    }
    void set_samples(std::size_t pixel, std::uint32_t samples) {
        statistics_[pixel * film_statistics_per_pixel + 5] = std::bit_cast<float>(samples);
    }
    std::vector<AdaptiveGroup> groups(std::uint64_t budget, std::uint64_t most) const {
        const FilmStrip strip{0, {}, statistics_};
        return adaptive_groups({&strip, 1}, errors, width, height, 100, budget, most);
    }

private:
    static constexpr std::size_t pixels = std::size_t{width} * height;
    std::vector<float> statistics_;

public:
    std::vector<float> errors;
};

std::uint64_t cost(const std::vector<AdaptiveGroup>& groups) {
    return std::accumulate(groups.begin(), groups.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const AdaptiveGroup& group) {
                               return sum + group.samples * group.pixels.size();
                           });
}

TEST(AdaptiveGroups, TheTileWithTheErrorGetsTheSamplesFirst) {
    SmallFilm film;
    film.errors[3 * 20 + 8] = 10.0f; // tile of columns 8 to 15, rows 0 to 7
    const auto groups = film.groups(64 * 16, 64 * 16);
    ASSERT_EQ(groups.size(), 1U);
    EXPECT_EQ(groups[0].samples, 16U);
    ASSERT_EQ(groups[0].pixels.size(), 64U);
    EXPECT_EQ(groups[0].pixels.front().pixel, 8U);
    EXPECT_EQ(groups[0].pixels.back().pixel, 7U * 20 + 15);
    for (const PixelSamples& pixel : groups[0].pixels)
        EXPECT_EQ(pixel.first_sample, 116U);
}

TEST(AdaptiveGroups, PixelsThatTellTheErrorDoNotDecide) {
    SmallFilm film;
    const auto before = film.groups(3000, 3000);
    film.errors[3 * 20 + 9] = 10.0f;
    EXPECT_FALSE(decides_where_samples_go(9, 3));
    const auto after = film.groups(3000, 3000);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i)
        EXPECT_EQ(after[i].pixels.size(), before[i].pixels.size());
}

TEST(AdaptiveGroups, KeepTheBudgetAndDoubleWholeTiles) {
    const SmallFilm film;
    for (const std::uint64_t budget : {500U, 3000U, 20000U, 1000000U}) {
        const auto groups = film.groups(budget, budget);
        EXPECT_LE(cost(groups), budget);
        EXPECT_GE(cost(groups), budget / 3) << budget; // the last tiles do not fit
        for (const AdaptiveGroup& group : groups)
            EXPECT_TRUE(std::has_single_bit(16 + group.samples)) << group.samples;
    }
}

TEST(AdaptiveGroups, TakeOneTileBeyondThePassButNoneBeyondTheRender) {
    const SmallFilm film;
    const auto groups = film.groups(1, 64 * 16);
    ASSERT_EQ(groups.size(), 1U);
    EXPECT_EQ(groups[0].samples, 16U);
    EXPECT_LE(groups[0].pixels.size(), 64U);
    EXPECT_TRUE(film.groups(1, 100).empty()); // the smallest tile has 4 x 4 pixels
}

TEST(AdaptiveGroups, ImagesWithoutErrorStillFinish) {
    SmallFilm film;
    std::fill(film.errors.begin(), film.errors.end(), 0.0f);
    const auto groups = film.groups(20000, 20000);
    EXPECT_GT(cost(groups), 0U);
    EXPECT_LE(cost(groups), 20000U);
}

/// A shiny sphere lit by a small lamp before a black sky: little of the film is noisy.
Scene half_empty_scene(int width, int height) {
    Scene scene = sphere_scene(material({layer(1.5, 0.3)}, 0.6), width, height);
    scene.lights = {RectangleLight{{2, 4, 3}, {1, 0, 0}, {0, 0, 1}, Spectrum::constant(5.0)}};
    return scene;
}

RenderOptions options_of(std::uint32_t samples, std::uint32_t seed, bool adaptive) {
    RenderOptions options;
    options.samples = samples;
    options.seed = seed;
    options.bands = grid_from_range(400, 700, 100);
    options.adaptive = adaptive;
    return options;
}

RenderResult rendered(std::uint32_t samples, std::uint32_t seed, bool adaptive, int width = 24) {
    return render(half_empty_scene(width, width), device(), options_of(samples, seed, adaptive));
}

TEST(Adaptive, TakesAsManySamplesOnTheAverageAndHasLessError) {
    const SpectralImage reference = rendered(4096, 1000, false, 40).image;
    double adaptive_error = 0.0, uniform_error = 0.0;
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
        const RenderResult adaptive = rendered(256, seed, true, 40),
                           uniform = rendered(256, seed, false, 40);
        EXPECT_LE(adaptive.paths, uniform.paths);
        EXPECT_GE(static_cast<double>(adaptive.paths), 0.7 * static_cast<double>(uniform.paths));
        adaptive_error += compare_images(adaptive.image, reference).relmse;
        uniform_error += compare_images(uniform.image, reference).relmse;
        const auto [least, most] = std::ranges::minmax(adaptive.image.sample_count);
        EXPECT_LT(least, 256.0f);
        EXPECT_GT(most, 256.0f);
    }
    EXPECT_LT(adaptive_error, uniform_error / 1.5);
}

/// Samples decide where more are taken, which could favour dark results. The mean of many renders
/// against many samples, in cells of four pixels and as a whole, in standard errors between
/// renders; what is rarer than a millionth of the image need not have been seen.
TEST(Adaptive, ImagesHaveNoBiasThatCanBeSeen) {
    const std::uint32_t renders = test::is_full_run() ? 4000 : 60;
    const SpectralImage reference =
        rendered(test::is_full_run() ? 1u << 18 : 1u << 13, 1000, false).image;
    const std::size_t entries = reference.values.size();
    std::vector<double> sums(entries / 16), squares(sums.size()), truth(sums.size());
    for (std::size_t i = 0; i < entries; ++i)
        truth[i / 16] += static_cast<double>(reference.values[i]);
    double total = 0.0, total_squares = 0.0;
    for (std::uint32_t seed = 0; seed < renders; ++seed) {
        const SpectralImage image = rendered(32, seed, true).image;
        std::vector<double> cells(sums.size());
        for (std::size_t i = 0; i < entries; ++i)
            cells[i / 16] += static_cast<double>(image.values[i]);
        const double all = std::accumulate(cells.begin(), cells.end(), 0.0);
        total += all;
        total_squares += all * all;
        for (std::size_t c = 0; c < cells.size(); ++c) {
            sums[c] += cells[c];
            squares[c] += cells[c] * cells[c];
        }
    }
    const double whole = std::accumulate(truth.begin(), truth.end(), 0.0);
    const auto check = [&](double sum, double sum_of_squares, double expected, double sigmas,
                           const std::string& what) {
        const double n = renders, mean = sum / n;
        const double tolerance = test::is_full_run() ? 5e-4 : 3e-3; // relative to the reference
        const double error = std::sqrt(std::max(0.0, sum_of_squares / n - mean * mean) / (n - 1));
        EXPECT_NEAR(mean, expected, sigmas * error + tolerance * expected + 1e-6 * whole) << what;
        return (mean - expected) / expected;
    };
    for (std::size_t c = 0; c < sums.size(); ++c)
        check(sums[c], squares[c], truth[c], test::sidak_bound(static_cast<int>(sums.size())),
              "cell " + std::to_string(c));
    const double bias = check(total, total_squares, whole, 5.0, "whole image");
    RecordProperty("relative_bias", std::to_string(bias));
}

TEST(Adaptive, ResumedRenderEqualsTheUninterruptedOne) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / "reradiant-adaptive.checkpoint";
    std::filesystem::remove(file);
    RenderOptions options = options_of(200, 7, true);
    options.checkpoint = file;
    const RenderResult whole = render(half_empty_scene(24, 24), device(), options);
    for (const std::uint32_t stop : {8u, 40u, 110u}) {
        options.resume = true;
        render(half_empty_scene(24, 24), device(), options,
               [&](const RenderProgress& state) { return state.samples < stop; });
    }
    const RenderResult resumed = render(half_empty_scene(24, 24), device(), options);
    EXPECT_GT(resumed.resumed_samples, 100U);
    EXPECT_EQ(resumed.image.values, whole.image.values);
    EXPECT_EQ(resumed.image.sample_count, whole.image.sample_count);
}

} // namespace
} // namespace reradiant
