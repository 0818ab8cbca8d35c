#include "tests/film/film_fixtures.h"

#include <random>

namespace reradiant {

namespace {

const WavelengthGrid bands = grid_from_range(400, 700, 100);

/// One pixel, four bands.
SpectralImage one_pixel(const std::vector<float>& values) {
    SpectralImage image = flat_image(1, 1, bands, 0.0f);
    image.values = values;
    return image;
}

} // namespace

TEST(Compare, EqualImagesDifferByNothing) {
    const SpectralImage image = flat_image(3, 2, bands, 0.25f);
    const Comparison result = compare_images(image, image);
    EXPECT_EQ(result.relmse, 0.0);
    EXPECT_EQ(result.relmse_srgb, 0.0);
    EXPECT_EQ(result.rmse, 0.0);
    EXPECT_EQ(result.bias, 0.0);
    EXPECT_EQ(result.bias_stderr, 0.0);
    EXPECT_EQ(result.ciede2000, 0.0);
    const SpectralImage black = flat_image(3, 2, bands, 0.0f);
    EXPECT_EQ(compare_images(black, black).relmse, 0.0);
}

TEST(Compare, RelativeErrorFollowsItsDefinition) {
    // Written out by hand: mean(ref) = 1, differences 0.5, 0, -1, 0.
    const Comparison result =
        compare_images(one_pixel({1.5f, 1.0f, 0.0f, 1.0f}), one_pixel({1.0f, 1.0f, 1.0f, 1.0f}));
    // 1e-12: a handful of double operations on numbers of order 1.
    EXPECT_NEAR(result.relmse, (0.25 + 1.0) / 1.01 / 4.0, 1e-12);
    EXPECT_NEAR(result.rmse, std::sqrt(1.25 / 4.0), 1e-12);
    EXPECT_NEAR(result.bias, -0.125, 1e-12);
    EXPECT_TRUE(std::isnan(result.bias_stderr)) << "one pixel has no spread";
}

TEST(Compare, DarkBandsUseTheMeanOfAllBands) {
    const Comparison result =
        compare_images(one_pixel({0.5f, 2.0f, 2.0f, 0.0f}), one_pixel({0.0f, 2.0f, 2.0f, 0.0f}));
    EXPECT_NEAR(result.relmse, 0.25 / 0.01 / 4.0, 1e-12);
}

TEST(Compare, RelativeErrorInSrgbFollowsItsDefinition) {
    const SpectralImage image = flat_image(1, 1, bands, 1.1f);
    const SpectralImage reference = flat_image(1, 1, bands, 1.0f);
    const std::vector<float> rgb = linear_srgb(reference);
    double wanted = 0.0;
    for (const float value : rgb)
        wanted += 0.01 * value * value / (value * value + 0.01) / 3.0;
    // 1e-6: 1.1 and linear_srgb are rounded to single precision here.
    EXPECT_NEAR(compare_images(image, reference).relmse_srgb, wanted, 1e-6);
}

TEST(Compare, BiasOfKnownNoiseLiesWithinItsStandardError) {
    constexpr int side = 100;
    constexpr double bias = 0.01, sigma = 0.2;
    const SpectralImage reference = flat_image(side, side, bands, 1.0f);
    SpectralImage image = reference;
    std::mt19937 random(3);
    std::normal_distribution<double> noise(bias, sigma);
    // One draw a pixel: the bands of a pixel share their paths.
    for (std::size_t pixel = 0; pixel < side * side; ++pixel) {
        const double value = noise(random);
        for (std::size_t band = 0; band < 4; ++band)
            image.values[4 * pixel + band] += static_cast<float>(value);
    }
    const Comparison result = compare_images(image, reference);
    // The standard deviation of 10^4 draws is known to 1 / sqrt(2e4) = 0.7 %; 5 % is 7 sigma.
    EXPECT_NEAR(result.bias_stderr, sigma / side, 0.05 * sigma / side);
    // 4.9 sigma: two-sided 1e-6.
    EXPECT_NEAR(result.bias, bias, 4.9 * sigma / side);
}

TEST(Compare, ColourDifferenceOfGreysIsThatOfTheirLightness) {
    // Equal energy at Y = 1 and Y = 0.5: L* = 100 and 76.069; chroma scales alike. The lightness
    // term alone is 23.93 / S_L with S_L at L = 88.03: 15.8; chroma adds some.
    const double difference = compare_images(flat_image(1, 1, grid_from_range(380, 780, 5), 0.5f),
                                             flat_image(1, 1, grid_from_range(380, 780, 5), 1.0f))
                                  .ciede2000;
    const double l = 0.5 * (100.0 + 76.069) - 50.0;
    const double s_l = 1.0 + 0.015 * l * l / std::sqrt(20.0 + l * l);
    EXPECT_GT(difference, 23.9 / s_l);
    // The chroma of equal energy under D65 differs by less than 3 units between the two.
    EXPECT_LT(difference, 23.9 / s_l + 1.0);
}

TEST(Compare, OtherSizesBandsAndNonFiniteValuesAreRefused) {
    const SpectralImage image = flat_image(3, 2, bands, 1.0f);
    error_message(2, [&] { compare_images(image, flat_image(2, 3, bands, 1.0f)); });
    error_message(2, [&] {
        compare_images(image, flat_image(3, 2, WavelengthGrid{410, 100, 4}, 1.0f));
    });
    SpectralImage broken = image;
    broken.values[4 * 5 + 2] = std::nanf("");
    const std::string message = error_message(2, [&] { compare_images(broken, image); });
    EXPECT_NE(message.find("pixel (2, 1), 600 nm"), std::string::npos) << message;
    error_message(2, [&] { compare_images(image, broken); });
}

} // namespace reradiant
