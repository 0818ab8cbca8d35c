#include "host/layers/models/adding.h"
#include "host/layers/rough/facet_shape.h"
#include "host/layers/rough/interface_file.h"
#include "host/layers/rough/lost_flux.h"
#include "host/layers/rough/specular_lobes.h"
#include "kernels/scatter/facet_shape.h"
#include "tests/layers/walk_stacks.h"
#include "tests/support/private_cache.h"

#include <gtest/gtest.h>

#include <array>

// Where adding sends the light that facets scatter more than once, and what deeper interfaces
// send through rough ones, against the random walk.

using namespace reradiant;
using kernels::Vec3;

namespace {

const test::PrivateCache cache("facet-shape");

/// Largest difference of adding's specular part from the walk's, over that part (or 0.001 per sr
/// where that is more), beyond four standard errors. Light comes from the more grazing direction,
/// from where the walk is less noisy.
double worst_difference(const LayerStack& stack, std::span<const std::array<double, 3>> angles) {
    const LayerWalk walk(stack, {.matrix = Eigen::MatrixXd::Zero(1, 1)}, {550.0});
    const auto adding = adding_bsdf(stack_at(stack, 550.0));
    double worst = 0.0;
    for (const auto& [theta_i, theta_o, phi] : angles) {
        const Vec3 wi = test::direction_deg(theta_i, 0), wo = test::direction_deg(theta_o, phi);
        const WalkEstimate found = estimate_walk(walk, wi, {&wo, 1}, 1U << 15U, 1);
        const double mean = found.mean.directional[0].specular(0);
        const double error = found.standard_error.directional[0].specular(0);
        const double difference = std::fabs(adding->specular(wi, wo) - mean) - 4.0 * error;
        worst = std::max(worst, difference / std::max(mean, 1e-3));
    }
    return worst;
}

constexpr std::array<std::array<double, 3>, 6> wide{
    {{60, 40, 180}, {75, 60, 170}, {75, 60, 90}, {80, 75, 150}, {80, 80, 180}, {80, 20, 0}}};

} // namespace

TEST(FacetShape, LightBetweenFacetsLeavesAsInTheWalk) {
    // a product of two cosines is off by 0.3 to 40 times; the tables' own noise is some per cent of
    // a light that is a tenth of the whole, and rare walks of large weight are left out of them
    struct Case {
        Distribution distribution;
        double alpha, ior;
    };
    for (const Case& c : {Case{Distribution::Ggx, 0.2, 1.5}, Case{Distribution::Ggx, 0.6, 2.2},
                          Case{Distribution::Beckmann, 0.3, 1.5}}) {
        const LayerStack stack{
            {plain_layer(c.ior, c.alpha, 0.0, Scattering::Multiple, c.distribution)}};
        EXPECT_LT(worst_difference(stack, wide), 0.05) << c.alpha << ' ' << c.ior;
    }
}

TEST(LostFlux, LeavesAsInTheWalk) {
    // found as a small difference of large shares it is off by 2 % of all that is reflected at once
    for (const double alpha : {0.03, 0.15, 0.4}) {
        const LayerStack stack{
            {plain_layer(1.5, alpha, 0.0, Scattering::Multiple, Distribution::Blinn)}};
        EXPECT_LT(worst_difference(stack, wide), 0.01) << alpha;
    }
}

TEST(LostFlux, IsExactlyNothingWhereNoFacetHidesAnother) {
    const auto flux = LostFlux::of(1.5, 0.03);
    for (const double cosine : {0.3, 0.5, 0.8, 1.0})
        EXPECT_EQ(flux->given_back(cosine), 0.0) << cosine;
    EXPECT_GT(flux->given_back(0.03), 0.005);
}

TEST(FacetShape, LittleIsLeftToTheResidual) {
    for (const double alpha : {0.05, 0.2, 1.0}) {
        const auto t = adding_bsdf(stack_at({{plain_layer(1.5, alpha, 0.0)}}, 550.0));
        for (const double c : {0.1, 0.3, 0.7, 1.0})
            EXPECT_LT(t->residual(c), 0.01 * t->specular_albedo(c)) << alpha << ' ' << c;
    }
}

TEST(FacetShape, IsReciprocalAndNotNegative) {
    const auto table = facet_shape({.eta = 1.5, .alpha = 0.2});
    ASSERT_TRUE(table);
    ASSERT_EQ(table->size(), SHAPE_TABLE_SIZE);
    for (const float ratio : *table)
        EXPECT_TRUE(ratio >= 0.0f && ratio < 1.0f) << ratio;
    for (const auto& [theta_i, theta_o, phi] : wide) {
        const Vec3 wi = test::direction_deg(theta_i, 0), wo = test::direction_deg(theta_o, phi);
        const double there = kernels::facet_shape_value(table->data(), 0.2, wi, wo);
        EXPECT_NEAR(kernels::facet_shape_value(table->data(), 0.2, wo, wi), there, 1e-15);
    }
}

TEST(FacetShape, SlopesReachFromOneAzimuthToTheOther) {
    const Vec3 wi = test::direction_deg(50, 0);
    EXPECT_NEAR(kernels::facet_shape_slope(0.2, wi, test::direction_deg(70, 180)), 0.0, 1e-12);
    EXPECT_NEAR(kernels::facet_shape_slope(0.2, wi, test::direction_deg(70, 0)), 1.0, 1e-12);
    // nothing to tell apart at the normal, and at grazing light nothing infinite
    EXPECT_TRUE(std::isfinite(kernels::facet_shape_slope(0.2, wi, test::direction_deg(0, 0))));
    EXPECT_TRUE(std::isfinite(kernels::facet_shape_slope(1e-3, kernels::vec3(1.0, 0.0, 1e-30),
                                                         kernels::vec3(1.0, 0.0, 1e-30))));
}

TEST(FacetShape, OnlyWhereFacetsAreWalkedBetween) {
    EXPECT_FALSE(facet_shape({.distribution = Distribution::Blinn}));
    EXPECT_FALSE(facet_shape({.scattering = Scattering::Single}));
}

TEST(FacetShape, IsKeptOnDiskAsItWasMade) {
    const RoughInterface interface { .eta = 1.5, .alpha = 0.25 };
    const auto made = facet_shape(interface);
    const InterfaceKey key{InterfaceNumbers::FacetShape, interface, 15000};
    const auto kept = read_interface_file(key.file(), key, SHAPE_TABLE_SIZE);
    ASSERT_TRUE(made && kept);
    EXPECT_EQ(std::vector<float>(kept->begin(), kept->end()), *made);
}

TEST(FacetShape, OneTableStandsForItsNeighbourhood) {
    EXPECT_EQ(facet_shape({.eta = 1.52, .alpha = 0.25}),
              facet_shape({.eta = 1.48, .alpha = 0.252}));
    EXPECT_NE(facet_shape({.eta = 1.5, .alpha = 0.25}), facet_shape({.eta = 1.6, .alpha = 0.25}));
}

TEST(DeeperLobe, GrowsWithTheAngleAsInTheWalk) {
    // a smooth interface beneath a rough one: at 60 degrees the lobe is three times as wide as at
    // the normal, and its peak a sixth of what a lobe of one width has
    constexpr std::array<std::array<double, 3>, 6> mirror{
        {{0, 0, 0}, {2, 0, 0}, {30, 30, 180}, {60, 60, 180}, {62, 60, 180}, {75, 75, 180}}};
    const auto stack = [](Distribution d) {
        return LayerStack{{plain_layer(1.55, 0.03, 0.0, Scattering::Multiple, d),
                           plain_layer(1.0, 0.0, 0.0, Scattering::Multiple, d)}};
    };
    EXPECT_LT(worst_difference(stack(Distribution::Beckmann), mirror), 0.03);
    EXPECT_LT(worst_difference(stack(Distribution::Blinn), mirror), 0.03);
    // two lobes of ggx do not make another one: between its peak and its tails
    EXPECT_LT(worst_difference(stack(Distribution::Ggx), mirror), 0.2);
}

TEST(DeeperLobe, HasTheWidthOfItsOwnFacetsWhereNothingBends) {
    LobeShape lobe;
    lobe.distribution = Distribution::Beckmann;
    lobe.alpha = 0.1;
    lobe.ior = 1.0;
    EXPECT_NEAR(lobe_width(lobe, 0.3, 0.8), 0.1, 1e-12);
    lobe.passages = {{0.2, 1.5, 1.5}};
    EXPECT_NEAR(lobe_width(lobe, 0.3, 0.8), 0.1, 1e-12);
    // at the normal a passage counts (n - 1) alpha / 2, both ways
    lobe.alpha = 0.0;
    lobe.passages = {{0.2, 1.0, 1.5}};
    EXPECT_NEAR(lobe_width(lobe, 1.0, 1.0), std::sqrt(2.0) * 0.05, 1e-12);
}
