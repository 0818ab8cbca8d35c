#include "kernels/scatter/fresnel.h"
#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

/// Largest relative difference between the device and the double twin, over outputs above `floor`.
double worst(const std::vector<float>& input, double floor, std::size_t output) {
    const std::size_t count = input.size() / 2;
    const std::vector<float> found = run_probe("probe_fresnel", input, count, 2);
    double result = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double c = input[2 * i], eta = input[2 * i + 1];
        const double expected = output == 0 ? kernels::fresnel_dielectric(c, eta)
                                            : kernels::fresnel_cos_transmitted(c, eta);
        EXPECT_TRUE(std::isfinite(found[2 * i + output])) << c << " " << eta;
        result = std::max(result, relative_difference(found[2 * i + output], expected, floor));
    }
    return result;
}

TEST(KernelFresnel, MatchesDoubleOverAnglesAndIndices) {
    Source source(1);
    std::vector<float> input;
    for (int i = 0; i < 200000; ++i) {
        input.push_back(static_cast<float>(source.uniform(0, 1)));
        input.push_back(static_cast<float>(source.uniform(1.0, 4.0)));
    }
    // Reflectance near Brewster's angle is the difference of equal terms: floor 1e-4.
    EXPECT_LT(worst(input, 1e-4, 0), 2e-5);
    EXPECT_LT(worst(input, 1e-4, 1), 1e-6);
}

TEST(KernelFresnel, Case14IndexNearOneKeepsItsReflectance) {
    std::vector<float> input;
    for (const float difference : {1e-4f, 1e-6f, -1e-6f})
        for (const float c : {1.0f, 0.7f, 0.3f}) {
            input.push_back(c);
            input.push_back(1.0f + difference);
        }
    EXPECT_LT(worst(input, 1e-20, 0), 1e-5);
}

TEST(KernelFresnel, Case13AndCase15EndsAreExact) {
    const std::vector<float> input = {0.3f, 1.0f, 0.0f, 1.5f, 0.2f, 1.0f / 1.5f};
    const std::vector<float> found = run_probe("probe_fresnel", input, 3, 2);
    EXPECT_EQ(found[0], 0.0f) << "equal media reflect nothing";
    EXPECT_EQ(found[2], 1.0f) << "grazing light is reflected";
    EXPECT_EQ(found[4], 1.0f) << "beyond the critical angle";
    EXPECT_EQ(found[5], 0.0f);
}

} // namespace
} // namespace reradiant
