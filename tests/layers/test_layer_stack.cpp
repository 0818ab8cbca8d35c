#include "host/layers/rough/interface_walk.h"
#include "kernels/scatter/microfacet.h"
#include "reradiant/stack_elements.h"

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
    EXPECT_EQ(std::get<SlabValues>(stack_at(stack, 500.0).at(1)).tau, 0.5);
    Layer dispersive;
    dispersive.ior = Spectrum::table({400, 700}, {1.5, 1.4});
    dispersive.alpha = 0.1;
    stack.layers.push_back(dispersive);
    EXPECT_TRUE(stack.is_dispersive());
    EXPECT_FALSE(stack.is_constant());
    EXPECT_FALSE(stack.is_smooth());
    EXPECT_NEAR(lowest_ior(stack_at(stack, 550.0)), 1.45, 1e-12);
}

TEST(Stack, IsAListOfElementsFromTheAirDown) {
    Layer paint;
    paint.ior = Spectrum::constant(1.5);
    paint.absorption = Spectrum::table({400, 600}, {0.0, 1.0});
    paint.scattering_coefficient = Spectrum::table({400, 600}, {0.0, 0.4});
    paint.thickness = 2.0;
    paint.flakes = Flakes{0.3, {}};
    Layer coat;
    coat.ior = Spectrum::constant(1.3);
    coat.film = ThinFilm{200.0, Spectrum::constant(1.8)};
    const LayerStack stack{{coat, paint}};
    const StackElements elements = stack_at(stack, 500.0);
    ASSERT_EQ(elements.size(), 5u);
    const auto& top = std::get<SurfaceValues>(elements[0]);
    EXPECT_EQ(top.ior_above, 1.0);
    EXPECT_EQ(top.ior_below, 1.3);
    EXPECT_EQ(top.film.ior, 1.8);
    EXPECT_EQ(top.wavelength_nm, 500.0);
    EXPECT_FALSE(std::get<SlabValues>(elements[1]).may_scatter);
    EXPECT_EQ(std::get<SurfaceValues>(elements[2]).ior_above, 1.3);
    const auto& slab = std::get<SlabValues>(elements[3]);
    EXPECT_EQ(slab.ior, 1.5);
    EXPECT_NEAR(slab.tau, 1.0, 1e-12);
    EXPECT_NEAR(slab.tau_scattering, 0.4, 1e-12);
    EXPECT_EQ(coverage_of(elements[4]), 0.3);
    EXPECT_EQ(surface_of(elements[4])->ior_above, 1.5);
    // the list is as long where the paint is clear, and its slab is still one that may scatter
    const StackElements clear = stack_at(stack, 400.0);
    ASSERT_EQ(clear.size(), elements.size());
    EXPECT_FALSE(scatters(clear[3]));
    EXPECT_TRUE(std::get<SlabValues>(clear[3]).may_scatter);
}

TEST(Stack, EndsInASubstrateOrInAir) {
    const LayerStack glass{{Layer{}}};
    const StackElements alone = stack_at(glass, 550.0);
    EXPECT_EQ(above_substrate(alone).size(), 2u);
    EXPECT_EQ(conductor_of(alone), nullptr);
    EXPECT_EQ(lowest_ior(alone), 1.5);
    EXPECT_EQ(lowest_ior(stack_at({}, 550.0)), 1.0);
    const StackElements on_metal = stack_over(alone, conductor_at(Conductor{}, 550.0));
    ASSERT_NE(conductor_of(on_metal), nullptr);
    EXPECT_EQ(conductor_of(on_metal)->ior_above, 1.5);
    EXPECT_EQ(above_substrate(on_metal).size(), 2u);
    const StackElements on_paper = stack_over(alone, DiffuseValues{.sigma = 0.3});
    EXPECT_EQ(conductor_of(on_paper), nullptr);
    EXPECT_EQ(std::get<DiffuseValues>(on_paper.back()).ior_above, 1.5);
    EXPECT_EQ(surface_of(on_paper.back()), nullptr);
}
