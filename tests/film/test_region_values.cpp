#include "host/film/region_values.h"
#include "tests/film/film_fixtures.h"

namespace reradiant {

namespace {

const WavelengthGrid bands = grid_from_range(400, 700, 100);

/// 4 x 3 pixels whose value is 1 + x + 10 y in every band.
SpectralImage ramp() {
    SpectralImage image = flat_image(4, 3, bands, 0.0f);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            for (int band = 0; band < bands.count; ++band)
                image.at(x, y, band) = static_cast<float>(1 + x + 10 * y);
    return image;
}

ImageRegion rectangle(int x0, int y0, int x1, int y1) {
    return {.name = "region", .x0 = x0, .y0 = y0, .x1 = x1, .y1 = y1};
}

} // namespace

TEST(RegionValues, RectangleHoldsBothCorners) {
    const RegionValues values = region_values(ramp(), rectangle(1, 0, 2, 1));
    EXPECT_EQ(values.pixels, 4u);
    ASSERT_EQ(values.radiance.size(), 4u);
    EXPECT_DOUBLE_EQ(values.radiance[3], (2 + 3 + 12 + 13) / 4.0);
}

TEST(RegionValues, DiskHoldsPixelsWithinItsRadius) {
    const ImageRegion disk{.name = "at", .x0 = 0, .y0 = 0, .x1 = 2, .y1 = 2, .radius = 1.0};
    const RegionValues values = region_values(ramp(), disk);
    EXPECT_EQ(values.pixels, 5u) << "the middle and its four neighbours";
    EXPECT_DOUBLE_EQ(values.radiance[0], 12.0);
}

TEST(RegionValues, StandardErrorIsOfTheVarianceWhereThereIsOne) {
    SpectralImage image = ramp();
    image.variance_bands.assign(image.values.size(), 0.16f);
    image.variance_y.assign(12, 0.04f);
    const RegionValues values = region_values(image, rectangle(0, 0, 3, 0));
    // 1e-6: the image is in single precision.
    EXPECT_NEAR(values.radiance_stderr[1], std::sqrt(0.16 / 4.0), 1e-6);
    EXPECT_NEAR(values.luminance_stderr, std::sqrt(0.04 / 4.0), 1e-6);
    EXPECT_EQ(values.radiance_error, ErrorSource::Variance);
}

TEST(RegionValues, OneSampleHasNoVariance) {
    SpectralImage image = ramp();
    image.variance_y.assign(12, 0.0f);
    image.sample_count.assign(12, 4.0f);
    image.sample_count[2] = 1.0f;
    EXPECT_EQ(region_values(image, rectangle(0, 0, 3, 0)).luminance_error, ErrorSource::Spread);
    EXPECT_EQ(region_values(image, rectangle(2, 0, 2, 0)).luminance_error, ErrorSource::Unknown);
    EXPECT_EQ(region_values(image, rectangle(0, 1, 3, 1)).luminance_error, ErrorSource::Variance);
}

TEST(RegionValues, StandardErrorIsOfTheSpreadElse) {
    const RegionValues values = region_values(ramp(), rectangle(0, 0, 3, 0));
    // 1, 2, 3, 4: a variance of 5/3.
    EXPECT_NEAR(values.radiance_stderr[1], std::sqrt(5.0 / 3.0 / 4.0), 1e-12);
    const double y_of_one = values.xyz[1] / 2.5;
    EXPECT_NEAR(values.luminance_stderr, y_of_one * std::sqrt(5.0 / 12.0), 1e-6);
    EXPECT_EQ(values.luminance_error, ErrorSource::Spread);
}

TEST(RegionValues, OnePixelWithoutVarianceHasNoKnownError) {
    const RegionValues values = region_values(ramp(), rectangle(2, 2, 2, 2));
    EXPECT_TRUE(std::isnan(values.radiance_stderr[0]));
    EXPECT_TRUE(std::isnan(values.luminance_stderr));
    EXPECT_EQ(values.radiance_error, ErrorSource::Unknown);
}

TEST(RegionValues, OutsideIsRefusedWithTheSize) {
    for (const ImageRegion& region : {rectangle(0, 0, 4, 0), rectangle(-1, 0, 1, 1),
                                      rectangle(0, 0, 0, 3), rectangle(9, 9, 9, 9)}) {
        const std::string message = error_message(2, [&] { region_values(ramp(), region); });
        EXPECT_NE(message.find("4 x 3 pixels"), std::string::npos) << message;
    }
}

} // namespace reradiant
