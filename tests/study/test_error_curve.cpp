#include "host/study/converge/error_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace reradiant {
namespace {

/// A method whose noise has relMSE 1/t after t seconds on top of a bias, 10 samples a second; the
/// estimate knows the noise to 10 %.
ErrorCurve curve(double bias) {
    ErrorCurve result;
    for (double seconds = 1.0; seconds < 1100.0; seconds *= 2.0) {
        CurveRow row;
        row.seconds = seconds;
        row.samples = static_cast<std::uint32_t>(10.0 * seconds);
        row.error.relmse = 1.0 / seconds + bias;
        row.error.rmse = std::sqrt(row.error.relmse);
        row.estimate = {1.0 / seconds, 0.9 / seconds, 1.1 / seconds};
        result.rows.push_back(row);
    }
    return result;
}

// 1e-9: the curves are exact power laws but for rounding.
TEST(ErrorCurve, UnbiasedCurveHasTheSlopesOfIndependentSamples) {
    EXPECT_NEAR(slope_over_samples(curve(0.0)), -0.5, 1e-9);
    EXPECT_NEAR(slope_over_seconds(curve(0.0)), -1.0, 1e-9);
    EXPECT_NEAR(efficiency(curve(0.0)), 1.0, 1e-9);
    EXPECT_GT(slope_over_samples(curve(0.1)), -0.4) << "a bias must show";
}

TEST(ErrorCurve, TimesAreReadBetweenRows) {
    EXPECT_NEAR(*seconds_to_reach(curve(0.0), 1e-2), 100.0, 1e-9);
    EXPECT_NEAR(*seconds_to_reach(curve(0.0), 2.0), 1.0, 1e-9) << "the first row is good enough";
    EXPECT_FALSE(seconds_to_reach(curve(0.0), 1e-4).has_value());
    EXPECT_FALSE(seconds_to_reach(ErrorCurve{}, 1.0).has_value());
}

TEST(ErrorCurve, BiasFloorIsWhatNoiseDoesNotExplain) {
    const BiasFloor none = bias_floor(curve(0.0), {});
    EXPECT_EQ(none.relmse, 0.0);
    EXPECT_GT(none.smallest_visible, 0.0);
    const BiasFloor biased = bias_floor(curve(0.05), {});
    EXPECT_NEAR(biased.relmse, 0.05, 1e-9);
    EXPECT_NEAR(*biased.seconds, 20.0, 1e-6) << "there, noise and bias are equal";
    // The reference's own error is no bias of the method.
    EXPECT_EQ(bias_floor(curve(0.05), {0.05, 0.045, 0.055}).relmse, 0.0);
}

TEST(ErrorCurve, DegenerateCurvesAreNotFitted) {
    EXPECT_TRUE(std::isnan(fitted_exponent({1.0}, {2.0})));
    EXPECT_TRUE(std::isnan(fitted_exponent({1.0, 1.0}, {2.0, 3.0})));
    EXPECT_NEAR(fitted_exponent({1.0, 2.0, 4.0, 8.0}, {1.0, 0.0, 0.25, 0.125}), -1.0, 1e-9)
        << "no logarithm of 0";
    EXPECT_TRUE(std::isnan(efficiency(ErrorCurve{})));
}

} // namespace
} // namespace reradiant
