#include "host/fit/synth/synth_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using namespace reradiant;

namespace {

double nm_of(double per_cm) {
    return 1e7 / per_cm;
}

/// Half widths in wavenumber, by bisection on each side of the peak: red, blue.
std::array<double, 2> half_widths(const WavenumberBand& band) {
    const double peak = wavenumber_per_cm(band.peak_nm);
    std::array<double, 2> result{};
    for (const std::size_t side : {0u, 1u}) {
        double inside = 0.0, outside = 3.0 * band.width_per_cm;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (inside + outside);
            (band(nm_of(peak + (side == 0 ? -middle : middle))) > 0.5 ? inside : outside) = middle;
        }
        result[side] = inside;
    }
    return result;
}

} // namespace

TEST(SynthBand, WidthAndSkewAreWhatTheySay) {
    for (const double skew : {0.4, 0.8, 1.0, 1.00001, 1.3, 3.0}) {
        const WavenumberBand band{.peak_nm = 550.0, .width_per_cm = 2500.0, .skew = skew};
        EXPECT_DOUBLE_EQ(band(550.0), 1.0);
        EXPECT_LT(band(549.0), 1.0);
        EXPECT_LT(band(551.0), 1.0);
        const auto half = half_widths(band);
        EXPECT_NEAR(half[0] + half[1], 2500.0, 1e-5) << skew; // rounding of 1e7 / (1e7 / x)
        EXPECT_NEAR(half[0] / half[1], skew, 1e-8) << skew;
    }
}

TEST(SynthBand, VanishesBeyondTheEndOfALogNormal) {
    const WavenumberBand red_tail{.peak_nm = 500.0, .width_per_cm = 2000.0, .skew = 3.0};
    // The argument of the logarithm is 0 at skew / (skew^2 - 1) widths to the blue.
    const double end = wavenumber_per_cm(500.0) + 2000.0 * 3.0 / 8.0;
    EXPECT_EQ(red_tail(nm_of(end + 1.0)), 0.0);
    EXPECT_GT(red_tail(nm_of(wavenumber_per_cm(500.0) - 5000.0)), 0.0);
}

TEST(SynthBand, MirrorImageTurnsTheBandAround) {
    const WavenumberBand band{.peak_nm = 480.0, .width_per_cm = 2200.0, .skew = 0.6};
    const double line = wavenumber_per_cm(510.0);
    const WavenumberBand image = mirrored(band, line);
    EXPECT_GT(image.peak_nm, 510.0);
    for (const double away : {-3000.0, -800.0, 0.0, 400.0, 1500.0})
        EXPECT_NEAR(image(nm_of(line - away)), band(nm_of(line + away)), 1e-12) << away;
    const WavenumberBand back = mirrored(image, line);
    EXPECT_NEAR(back.peak_nm, band.peak_nm, 1e-10);
    EXPECT_NEAR(back.skew, band.skew, 1e-15);
}

TEST(SynthBand, SpectraAreScaledToTheirPeak) {
    const Spectrum two = spectrum_of_bands({{.peak_nm = 540, .width_per_cm = 1800, .skew = 0.7},
                                            {.peak_nm = 370, .width_per_cm = 3000, .height = 0.5}},
                                           0.8);
    EXPECT_NEAR(two.maximum(200, 1000), 0.8, 1e-12);
    EXPECT_NEAR(two(540), 0.8, 1e-6); // the other band's tail is far away
    EXPECT_NEAR(two(370), 0.4, 1e-3);
    EXPECT_EQ(two(150), 0.0);
    EXPECT_EQ(two(1600), 0.0);
    EXPECT_THROW(spectrum_of_bands({}, 1.0), std::invalid_argument);
}
