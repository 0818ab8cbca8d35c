#include "reradiant/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace reradiant;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Mean by a midpoint rule fine enough to check the closed forms to 1e-9.
double brute_average(const Spectrum& spectrum, double from, double to) {
    constexpr int pieces = 200000;
    double sum = 0.0;
    for (int k = 0; k < pieces; ++k)
        sum += spectrum(from + (k + 0.5) * (to - from) / pieces);
    return sum / pieces;
}

} // namespace

TEST(Spectrum, TableIsLinearBetweenAndConstantOutside) {
    const Spectrum table = Spectrum::table({400, 500, 700}, {0.0, 1.0, 0.5});
    EXPECT_EQ(table(350), 0.0);
    EXPECT_DOUBLE_EQ(table(450), 0.5);
    EXPECT_DOUBLE_EQ(table(600), 0.75);
    EXPECT_EQ(table(500), 1.0);
    EXPECT_EQ(table(900), 0.5);
    EXPECT_EQ(table.data_from_nm(), 400.0);
    EXPECT_EQ(table.data_to_nm(), 700.0);
}

TEST(Spectrum, Case35DuplicatedWavelengthIsRefused) {
    EXPECT_THROW(Spectrum::table({400, 400}, {1, 2}), std::invalid_argument);
}

TEST(Spectrum, Case35UnsortedEmptyNanAndInfiniteAreRefused) {
    EXPECT_THROW(Spectrum::table({500, 400}, {1, 2}), std::invalid_argument);
    EXPECT_THROW(Spectrum::table({}, {}), std::invalid_argument);
    EXPECT_THROW(Spectrum::table({400, nan_value}, {1, 2}), std::invalid_argument);
    EXPECT_THROW(Spectrum::table({400, 500}, {1, nan_value}), std::invalid_argument);
    EXPECT_THROW(Spectrum::table({400, 500}, {1, infinity}), std::invalid_argument);
    EXPECT_THROW(Spectrum::table({400, 500}, {1}), std::invalid_argument);
    EXPECT_THROW(Spectrum::constant(nan_value), std::invalid_argument);
}

TEST(Spectrum, Case35SinglePointIsAConstant) {
    const Spectrum point = Spectrum::table({550}, {0.3});
    EXPECT_TRUE(point.is_constant());
    EXPECT_EQ(point(300), 0.3);
    EXPECT_EQ(point.data_to_nm(), infinity);
}

TEST(Spectrum, AveragesAreTheIntegralsOfTheParts) {
    Spectrum sum = Spectrum::constant(0.1);
    sum += Spectrum::table({400, 437, 500.5, 612}, {0.2, 1.0, 0.3, 0.9});
    sum += Spectrum::gaussian(520, 20, 0.7);
    sum += Spectrum::blackbody(2856, 0.5);
    // The midpoint rule's own error is below 1e-9 here.
    for (const auto& [from, to] : {std::pair{380.0, 780.0}, {433.0, 441.0}, {500.0, 500.7}})
        EXPECT_NEAR(sum.average(from, to), brute_average(sum, from, to), 1e-9);
    EXPECT_EQ(sum.average(450, 450), sum(450));
    EXPECT_DOUBLE_EQ(sum.average(500, 400), sum.average(400, 500));
}

TEST(Spectrum, BoxIsExactHoweverNarrow) {
    const Spectrum box = Spectrum::line(404.66, 0.01, 3.0);
    // The edges of a box of 0.01 nm at 400 nm are rounded to 1e-11 of its width.
    EXPECT_NEAR(box.average(400, 410) * 10.0, 3.0, 1e-10);
    EXPECT_NEAR(box.average(404.66, 410) * 5.34, 1.5, 1e-10);
    EXPECT_EQ(box.average(405, 410), 0.0);
    EXPECT_EQ(box(404.0), 0.0);
    EXPECT_NEAR(box(404.66), 300.0, 1e-9);
    EXPECT_TRUE(box.without_lines().is_zero());
    EXPECT_EQ(box.lines().size(), 1u);
}

TEST(Spectrum, GaussianTailsKeepTheirRelativePrecision) {
    const Spectrum gaussian = Spectrum::gaussian(500, 10, 1);
    // Integral of the tail from 20 sigma on, by its asymptotic series (relative 2e-9 there).
    const double t = 20.0, series = 1 - 1 / (t * t) + 3 / std::pow(t, 4) - 15 / std::pow(t, 6) +
                                    105 / std::pow(t, 8) - 945 / std::pow(t, 10);
    const double expected = 10.0 * std::exp(-0.5 * t * t) / t * series;
    EXPECT_NEAR(gaussian.average(700, 900) * 200.0 / expected, 1.0, 1e-8);
    EXPECT_NEAR(gaussian.average(100, 300) * 200.0 / expected, 1.0, 1e-8);
    EXPECT_NEAR(gaussian.average(499.9999, 500.0001), 1.0, 1e-10);
}

TEST(Spectrum, BlackbodyFollowsPlanckAndStaysFinite) {
    // Ratio from Planck's law with c2 = 1.438776877e7 nm K, computed with 30 digits.
    const Spectrum lamp = Spectrum::blackbody(2856, 100);
    EXPECT_NEAR(lamp(560), 100.0, 1e-12);
    const double c2 = 1.438776877e7 / 2856;
    EXPECT_NEAR(lamp(400), 100 * std::pow(1.4, 5) * std::expm1(c2 / 560) / std::expm1(c2 / 400),
                1e-10);
    for (const double kelvin : {100.0, 1000.0, 6500.0, 1e5, 1e9})
        for (const double l : {1.0, 300.0, 560.0, 780.0, 2500.0})
            EXPECT_TRUE(std::isfinite(Spectrum::blackbody(kelvin, 1)(l))) << kelvin << " " << l;
    EXPECT_EQ(lamp(0.0), 0.0);
    EXPECT_THROW(Spectrum::blackbody(0, 1), std::invalid_argument);
    EXPECT_THROW(Spectrum::blackbody(-5, 1), std::invalid_argument);
}

TEST(Spectrum, BlackbodyAverageIsExactWhereItIsSteep) {
    // At 100 K the value grows by e^1.6 per nm at 300 nm: closed form of the steep side by many
    // small panels.
    const Spectrum cold = Spectrum::blackbody(100, 1);
    double sum = 0.0;
    for (int k = 0; k < 1000; ++k)
        sum += cold.average(300 + 0.01 * k, 300.01 + 0.01 * k) / 1000;
    EXPECT_NEAR(cold.average(300, 310) / sum, 1.0, 1e-10);
}

TEST(Spectrum, ConstancyAndZerosAreSeen) {
    EXPECT_TRUE(Spectrum().is_zero());
    EXPECT_TRUE(Spectrum::constant(0.5).is_constant());
    EXPECT_FALSE(Spectrum::constant(0.5).is_zero());
    EXPECT_TRUE(Spectrum::table({400, 500}, {0.2, 0.2}).is_constant());
    EXPECT_FALSE(Spectrum::table({400, 500}, {0.2, 0.3}).is_constant());
    EXPECT_TRUE(Spectrum::table({400, 500}, {0.0, 0.0}).is_zero());
    EXPECT_TRUE(Spectrum::gaussian(500, 10, 0).is_zero());
    EXPECT_FALSE(Spectrum::line(500, 1, 1).is_constant());
}

TEST(Spectrum, ZeroRangesAreSeen) {
    const Spectrum lamp = Spectrum::table({379, 380, 500}, {0, 1, 1});
    EXPECT_TRUE(lamp.is_zero_within(300, 379));
    EXPECT_FALSE(lamp.is_zero_within(300, 380));
    EXPECT_TRUE(Spectrum::gaussian(500, 10, 1).is_zero_within(300, 439));
    EXPECT_FALSE(Spectrum::gaussian(500, 10, 1).is_zero_within(300, 441));
    EXPECT_TRUE(Spectrum::line(405, 10, 1).is_zero_within(410, 780));
    EXPECT_FALSE(Spectrum::line(405, 10, 1).is_zero_within(409, 780));
    EXPECT_FALSE(Spectrum::blackbody(2856, 1).is_zero_within(300, 301));
    EXPECT_TRUE(
        Spectrum::table({300, 400, 401, 402, 780}, {0, 0, 1, 0, 0}).is_zero_within(402, 780));
    EXPECT_FALSE(
        Spectrum::table({300, 400, 401, 402, 780}, {0, 0, 1, 0, 0}).is_zero_within(300, 780));
}

TEST(Spectrum, ExtremaAreFoundAtNodesBetweenTheComb) {
    const Spectrum table = Spectrum::table({400, 450.5, 500}, {0.5, 1.5, -0.5});
    EXPECT_EQ(table.maximum(300, 800), 1.5);
    EXPECT_EQ(table.minimum(300, 800), -0.5);
    EXPECT_DOUBLE_EQ(table.minimum(400, 450.5), 0.5);
    EXPECT_NEAR(Spectrum::line(404.66, 0.1, 1).maximum(300, 800), 10.0, 1e-9);
    EXPECT_EQ(Spectrum::line(404.66, 0.1, 1).minimum(300, 800), 0.0);
}

TEST(Spectrum, AddingAndScalingKeepEveryPart) {
    Spectrum sum = Spectrum::gaussian(500, 10, 1);
    sum += Spectrum::line(600, 2, 4);
    sum += sum;
    const Spectrum scaled = sum.scaled(0.5);
    EXPECT_NEAR(scaled(500), 1.0, 1e-15);
    EXPECT_NEAR(scaled(600), 2.0, 1e-15);
    EXPECT_EQ(sum.lines().size(), 2u);
    EXPECT_THROW(sum.scaled(nan_value), std::invalid_argument);
}
