#include "kernels/scatter/microfacet.h"
#include "reradiant/layer_stack.h"

#include "host/layers/rough/interface_walk.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace reradiant;

TEST(Stack, RoughnessIsTheAngleWhereTheDistributionFallsToOneHalf) {
    for (const Distribution d : {Distribution::Blinn, Distribution::Beckmann, Distribution::Ggx}) {
        for (const double degrees : {0.01, 1.0, 10.0, 30.0}) {
            const double alpha = alpha_from_roughness_deg(d, degrees);
            const double b = degrees * M_PI / 180.0;
            const int k = kernel_distribution(d);
            const double top = kernels::microfacet_d(k, alpha, kernels::vec3(0, 0, 1));
            const double half =
                kernels::microfacet_d(k, alpha, kernels::vec3(std::sin(b), 0, std::cos(b)));
            // at 0.01 degrees rounding of b enters magnified
            EXPECT_NEAR(half / top, 0.5, 1e-7) << degrees;
        }
        EXPECT_EQ(alpha_from_roughness_deg(d, 0.0), 0.0);
    }
}

TEST(Stack, BlinnExponentFollowsAlpha) {
    const double exponent = -std::log(2.0) / std::log(std::cos(0.2));
    const double alpha = alpha_from_roughness_deg(Distribution::Blinn, 0.2 * 180.0 / M_PI);
    EXPECT_NEAR(blinn_exponent(alpha) / exponent, 1.0, 1e-12);
}

TEST(Stack, KnowsWhatDependsOnWavelength) {
    LayerStack stack;
    EXPECT_TRUE(stack.is_smooth());
    EXPECT_TRUE(stack.is_constant());
    Layer grey;
    grey.thickness = 2.0;
    grey.absorption = Spectrum::constant(0.25);
    stack.layers.push_back(grey);
    EXPECT_TRUE(stack.is_constant());
    EXPECT_TRUE(stack.absorbs());
    EXPECT_EQ(stack_at(stack, 500.0).front().tau, 0.5);
    Layer dispersive;
    dispersive.ior = Spectrum::table({400, 700}, {1.5, 1.4});
    dispersive.alpha = 0.1;
    stack.layers.push_back(dispersive);
    EXPECT_TRUE(stack.is_dispersive());
    EXPECT_FALSE(stack.is_constant());
    EXPECT_FALSE(stack.is_smooth());
    EXPECT_NEAR(stack_at(stack, 550.0).back().ior, 1.45, 1e-12);
}
