#include "host/report/plot_frame.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace reradiant::svg;

namespace {

/// Every tick is 1, 2 or 5 (times whole numbers on linear axes) of a power of ten.
void expect_round(const Axis& axis) {
    ASSERT_GE(axis.ticks.size(), 2u);
    ASSERT_LE(axis.ticks.size(), 20u);
    const double step = axis.ticks[1] - axis.ticks[0];
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    EXPECT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
                std::abs(mantissa - 5) < 1e-6)
        << step;
    for (const double tick : axis.ticks)
        EXPECT_NEAR(tick / step, std::round(tick / step), 1e-6);
}

} // namespace

TEST(PlotFrame, LinearTicksAreRoundAndHoldTheRange) {
    for (const auto& [low, high] : {std::pair{0.0, 1.0},
                                    {300.0, 780.0},
                                    {-0.013, 0.29},
                                    {1e-9, 3e-9},
                                    {-7e8, 1e6},
                                    {0.1, 0.3}}) {
        const Axis axis = make_axis(low, high, false, false);
        expect_round(axis);
        // A thousandth of a step may be cut, not more.
        EXPECT_LE(axis.low, low + 2e-4 * (high - low));
        EXPECT_GE(axis.high, high - 2e-4 * (high - low));
    }
}

TEST(PlotFrame, ExactAxesKeepTheirEnds) {
    const Axis axis = make_axis(295, 785, false, true);
    EXPECT_EQ(axis.low, 295);
    EXPECT_EQ(axis.high, 785);
    EXPECT_EQ(axis.labels.front(), "300");
    EXPECT_EQ(axis.labels.back(), "700");
}

TEST(PlotFrame, RangesWithoutExtentAreWidened) {
    for (const double value : {0.0, 5.0, -1e-12, 1e300}) {
        const Axis axis = make_axis(value, value, false, false);
        EXPECT_LT(axis.low, value);
        EXPECT_GT(axis.high, value);
        EXPECT_GE(axis.ticks.size(), 2u);
    }
    const Axis axis = make_axis(3.0, 3.0, true, false);
    EXPECT_LT(axis.low, 3.0);
    EXPECT_GT(axis.high, 3.0);
}

TEST(PlotFrame, LogarithmicTicksAreDecades) {
    const Axis axis = make_axis(2e-7, 40, true, false);
    EXPECT_EQ(axis.labels.front(), "10⁻⁷");
    EXPECT_NEAR(axis.share(axis.low * std::sqrt(axis.high / axis.low)), 0.5, 1e-12);
    // Less than two decades: 2 and 5 are labelled too, so that there is something to read off.
    EXPECT_GE(make_axis(3, 40, true, false).ticks.size(), 4u);
    // Many decades: some are left out.
    EXPECT_LE(make_axis(1e-40, 1, true, false).ticks.size(), 12u);
}

TEST(PlotFrame, LabelsAreShort) {
    EXPECT_EQ(number_label(0), "0");
    EXPECT_EQ(number_label(0.1 + 0.2), "0.3");
    EXPECT_EQ(number_label(-2.5), "-2.5");
    EXPECT_EQ(number_label(1e5), "10⁵");
    EXPECT_EQ(number_label(-2e-6), "-2·10⁻⁶");
    EXPECT_EQ(number_label(20000), "20000");
    EXPECT_EQ(number_label(9.999999999e11), "10¹²");
}
