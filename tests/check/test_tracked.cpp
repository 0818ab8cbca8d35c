#include "host/check/tracked.h"

#include "host/check/checked_function.h"
#include "kernels/scatter/microfacet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace reradiant {
namespace {

using tracked::Tracked;

double relative(Tracked x) {
    return x.error / std::fabs(x.value);
}

TEST(Tracked, ExactNumbersAndSumsOfThemHaveNoError) {
    EXPECT_EQ((Tracked(1.5) + Tracked(0.25)).error, 0.0);
    EXPECT_EQ((Tracked(1.5) * Tracked(3.0)).error, 0.0);
    EXPECT_GT(Tracked(0.1).error, 0.0) << "a constant that single precision rounds";
}

TEST(Tracked, TellsAStableFormFromOneThatCancels) {
    // case 8: 1 - z^2 of a facet normal at alpha 1e-3, against x^2 + y^2
    const double x = static_cast<double>(1e-3f);
    const Tracked z = tracked::sqrt(Tracked(1.0) - Tracked(x) * Tracked(x));
    EXPECT_GT(relative(Tracked(1.0) - z * z), 0.05);
    EXPECT_LT(relative(Tracked(x) * Tracked(x)), 1e-7);
}

/// A function of two numbers in single precision and tracked: the bound must hold the difference.
template <typename Single, typename Twin>
void expect_bounded(Single single, Twin twin) {
    InputRandom random(3, 0);
    for (int i = 0; i < 20000; ++i) {
        const auto a = static_cast<float>(random.uniform(0.01, 2.0));
        const auto b = static_cast<float>(random.uniform(0.01, 2.0));
        const Tracked expected =
            twin(Tracked(static_cast<double>(a)), Tracked(static_cast<double>(b)));
        const double found = static_cast<double>(single(a, b));
        ASSERT_LE(std::fabs(found - expected.value), expected.error) << a << ' ' << b;
        ASSERT_LE(expected.error, 1e-4 * std::fabs(expected.value) + 1e-5) << "says nothing";
    }
}

TEST(Tracked, BoundsHoldWhatSinglePrecisionDoes) {
    using std::atan2, std::cos, std::erf, std::exp, std::log1p, std::sqrt;
    expect_bounded([](float a, float b) { return sqrt(a * a + b) / (a + 0.3f * b); },
                   [](Tracked a, Tracked b) {
                       return sqrt(a * a + b) / (a + Tracked(static_cast<double>(0.3f)) * b);
                   });
    expect_bounded([](float a, float b) { return exp(-a * b) * cos(b) + erf(a); },
                   [](Tracked a, Tracked b) { return exp(-a * b) * cos(b) + erf(a); });
    expect_bounded([](float a, float b) { return log1p(a * b) - atan2(a, b); },
                   [](Tracked a, Tracked b) { return log1p(a * b) - atan2(a, b); });
}

TEST(Tracked, NoticesComparisonsThatRoundingDecides) {
    const Tracked third = Tracked(1.0) / Tracked(3.0);
    tracked::undecided = false;
    EXPECT_TRUE(third < Tracked(0.5));
    EXPECT_FALSE(tracked::undecided);
    static_cast<void>(third * Tracked(3.0) < Tracked(1.0));
    EXPECT_TRUE(tracked::undecided);
}

TEST(InputSequence, ItemsDoNotDependOnWhereABlockBegins) {
    const Arguments arguments{cosine(), ior(), direction(), any_direction(), unit()};
    const InputSequence sequence("some function", arguments);
    const std::size_t width = sequence.width();
    EXPECT_EQ(width, 9U);
    std::vector<float> together(100 * width), apart(40 * width);
    const std::uint64_t first = sequence.hard_count() - 30;
    sequence.fill(first, together);
    sequence.fill(first + 60, apart);
    for (std::size_t i = 0; i < apart.size(); ++i)
        EXPECT_EQ(apart[i], together[60 * width + i]);
    for (const float value : together)
        EXPECT_TRUE(std::isfinite(value));
}

} // namespace
} // namespace reradiant
