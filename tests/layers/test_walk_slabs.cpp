#include "reradiant/error.h"
#include "tests/layers/walk_parts.h"
#include "tests/support/directions.h"
#include "tests/support/private_cache.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

using namespace reradiant;
using namespace reradiant::test;

namespace {

const PrivateCache cache("walk_slabs");

/// Every entry within `bound` joint standard errors; what neither saw is to be 0.
void expect_near(const Eigen::MatrixXd& value, const Eigen::MatrixXd& error, const SlabTruth& truth,
                 double bound, const std::string& what) {
    for (int o = 0; o < 3; ++o)
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(value(o, i), truth.value()(o, i),
                        bound * std::hypot(error(o, i), truth.error()(o, i)) + 1e-12)
                << what << ", from band " << i << " to " << o;
}

} // namespace

TEST(WalkSlabs, AgreeWithAnIndependentWalk) {
    std::uint64_t seed = 1;
    for (const SlabCase& one : slab_cases()) {
        const WalkEstimate found =
            estimate_walk(walk_of(one.stack, one.substrate), direction_deg(one.theta_i_deg), {},
                          samples(100000), seed++);
        const auto compare = [&](const WalkTally::Parts& mean, const WalkTally::Parts& error,
                                 const SlabTruth& truth, const char* side) {
            expect_near(all_light(mean), all_errors(error), truth, 4.0,
                        std::string(one.name) + ", " + side);
        };
        compare(found.mean.hemispherical, found.standard_error.hemispherical, one.reflected,
                "reflected");
        if (one.stack.is_sheet())
            compare(found.mean.transmitted, found.standard_error.transmitted, one.transmitted,
                    "transmitted");
        EXPECT_LE(column_sums(found.mean).maxCoeff(), 1.0 + 1e-9) << one.name;
    }
}

TEST(WalkSlabs, ClosedFormsOfADyeWithoutReabsorption) {
    const double depth = 0.7, share = 0.8, bound = sidak_bound(4);
    LayerStack stack{{dyed_layer(1.0, {depth, 0, 0}, {0, 0, 0, share, 0, 0, 0, 0, 0})},
                     LowerFace{}};
    const kernels::Vec3 wi = direction_deg(50);
    const WalkEstimate found = estimate_walk(walk_of(stack), wi, {}, samples(40000), 1);
    const double absorbed = -std::expm1(-depth / wi.z);
    for (const auto& [mean, error] :
         {std::pair{found.mean.hemispherical.slab(1, 0),
                    found.standard_error.hemispherical.slab(1, 0)},
          {found.mean.transmitted.slab(1, 0), found.standard_error.transmitted.slab(1, 0)}})
        EXPECT_NEAR(mean, absorbed * share / 2.0, bound * error);
    EXPECT_NEAR(found.mean.transmitted.specular(0), 1.0 - absorbed,
                bound * found.standard_error.transmitted.specular(0));
    EXPECT_EQ(found.mean.guided.sum(), 0.0);
    // the same in the direction asked for: emission per volume over 4 pi and the cosine
    const kernels::Vec3 below = direction_deg(140);
    const WalkEstimate seen = estimate_walk(walk_of(stack), wi, {&below, 1}, samples(40000), 2);
    EXPECT_NEAR(seen.mean.directional[0].slab(1, 0),
                absorbed * share / (4.0 * std::numbers::pi * -below.z),
                bound * seen.standard_error.directional[0].slab(1, 0));
}

TEST(WalkSlabs, Case61AClearSheetGuidesWhatItReflectsTotally) {
    // in one slab, and in one of three that the light crosses on its way to and fro
    const Layer dyed = dyed_layer(1.5, {3, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 0, 0});
    Layer denser, lighter;
    denser.ior = Spectrum::constant(1.7);
    lighter.ior = Spectrum::constant(1.4);
    const double bound = sidak_bound(4);
    for (const bool is_pile : {false, true}) {
        LayerStack stack{{dyed}, LowerFace{}};
        if (is_pile)
            stack.layers = {denser, dyed, lighter};
        const WalkEstimate found =
            estimate_walk(walk_of(stack), direction_deg(20), {}, samples(40000), 3);
        const double guided = found.mean.guided(1, 0);
        const double emitted =
            guided + found.mean.hemispherical.slab(1, 0) + found.mean.transmitted.slab(1, 0);
        const double share = std::sqrt(1.0 - 1.0 / (1.5 * 1.5));
        EXPECT_NEAR(guided, share * emitted, bound * found.standard_error.guided(1, 0) + 1e-12)
            << is_pile;
        EXPECT_GT(emitted, 0.5);
        // all light that comes ends somewhere, and all weights are 1
        EXPECT_NEAR(column_sums(found.mean)(0), 1.0, 1e-12) << is_pile;
        EXPECT_EQ(found.mean.guided.col(1).sum(), 0.0);
    }
}

TEST(WalkSlabs, Case61GuidedLightThatIsHardlyAbsorbedEnds) {
    LayerStack stack{{dyed_layer(1.5, {3, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 0, 0}),
                      dyed_layer(1.6, {0, 1e-9, 0}, {0, 0, 0, 0, 0, 0, 0, 1, 0})},
                     LowerFace{}};
    const WalkEstimate found =
        estimate_walk(walk_of(stack), direction_deg(20), {}, samples(4000), 3);
    // every passage of a guided ray weighs little, and in the end all of them take it to band 2
    EXPECT_NEAR(column_sums(found.mean)(0), 1.0, 1e-12);
    EXPECT_LT(found.mean.guided(1, 0), 1e-6);
    EXPECT_GT(found.mean.guided(2, 0), 0.3);
}

TEST(WalkSlabs, Case62YieldOneLosesNothing) {
    const std::vector<double> within{1, 0, 0, 0, 1, 0, 0, 0, 1};
    Layer layer = dyed_layer(1.5, {0.5, 3, 20}, within);
    layer.alpha = 0.3;
    LayerStack stack{{layer}, LowerFace{}};
    for (const double theta : {0.0, 45.0, 89.9, 95.0, 180.0}) {
        const WalkEstimate found =
            estimate_walk(walk_of(stack), direction_deg(theta), {}, samples(1024), 3);
        EXPECT_TRUE(column_sums(found.mean).isApproxToConstant(1.0, 1e-12)) << theta;
        EXPECT_EQ(found.mean.guided.sum(), 0.0) << theta;
    }
}

TEST(WalkSlabs, DyedStacksOverSubstratesRunBackwardsToo) {
    const std::vector<double> shares{.1, 0, 0, .4, .2, 0, .2, .5, .3};
    Layer dyed = dyed_layer(1.5, {.8, .3, 0}, shares);
    dyed.ior = at_three_bands({1.7, 1.6, 1.5});
    dyed.alpha = 0.2;
    const LayerStack stack{{dyed, dyed_layer(1.3, {.2, .6, .1}, shares)}};
    const SurfaceValues metal{.ior_below = 0.3, .kappa = 3.0, .is_conductor = true, .alpha = 0.3};
    const SubstrateValues paint{.matrix = matrix_of_three({.3, 0, 0, .3, .5, 0, .1, .3, .8})},
        foil{.matrix = {}, .conductor = {metal, metal, metal}};
    const kernels::Vec3 a = direction_deg(20), b = direction_deg(65, 50);
    const double bound = sidak_bound(2.0 * 6.0 * 2.0);
    for (const SubstrateValues* substrate : {&paint, &foil}) {
        const LayerWalk walk(stack, *substrate, three_bands.centres_nm(),
                             slab_emissions(stack, three_bands));
        const WalkEstimate there = estimate_walk(walk, a, {&b, 1}, samples(10000), 1);
        const WalkEstimate back = estimate_walk(walk.reversed(), b, {&a, 1}, samples(10000), 2);
        const WalkTally::Parts &m = there.mean.directional[0], &n = back.mean.directional[0],
                               &e = there.standard_error.directional[0],
                               &f = back.standard_error.directional[0];
        for (int o = 0; o < 3; ++o) {
            for (int i = 0; i <= o; ++i) {
                EXPECT_NEAR(m.diffuse(o, i), n.diffuse(i, o),
                            bound * std::hypot(e.diffuse(o, i), f.diffuse(i, o)));
                EXPECT_NEAR(m.slab(o, i), n.slab(i, o),
                            bound * std::hypot(e.slab(o, i), f.slab(i, o)));
                EXPECT_GT(m.diffuse(o, i), 0.0);
                EXPECT_GT(m.slab(o, i), 0.0);
            }
        }
    }
}

TEST(WalkSlabs, Case60ThinAndThickDyesKeepTheirLight) {
    const std::vector<double> up{0, 0, 0, 1, 0, 0, 0, 0, 0};
    const auto found = [&](double depth) {
        const LayerStack stack{{dyed_layer(1.0, {depth, 0, 0}, up)}, LowerFace{}};
        return estimate_walk(walk_of(stack), direction_deg(0), {}, samples(4000), 3);
    };
    // all of a thick slab's emission lies at its upper face, and half of it goes up
    const WalkEstimate thick = found(1e3);
    EXPECT_NEAR(thick.mean.hemispherical.slab(1, 0), 0.5,
                5.0 * thick.standard_error.hemispherical.slab(1, 0));
    EXPECT_NEAR(column_sums(thick.mean)(0), 1.0, 1e-12);
    const WalkEstimate thin = found(1e-8);
    EXPECT_NEAR(column_sums(thin.mean)(0), 1.0, 1e-12);
    EXPECT_NEAR(thin.mean.transmitted.specular(0), 1.0, 1e-3);
}

TEST(WalkSlabs, Case60ADyeOfConcentrationZeroIsNone) {
    Layer with = dyed_layer(1.5, {1, .4, 0}, {0, 0, 0, .5, 0, 0, .2, .7, 0});
    with.scattering_coefficient = Spectrum::constant(1.0);
    with.alpha = 0.2;
    Layer without = with;
    with.dyes[0].concentration = 0.0;
    without.dyes.clear();
    const auto found = [](const Layer& layer) {
        const kernels::Vec3 wo = direction_deg(160);
        return estimate_walk(walk_of({{layer}, LowerFace{}}), direction_deg(30), {&wo, 1}, 500, 3)
            .mean;
    };
    const WalkTally a = found(with), b = found(without);
    EXPECT_EQ(a.hemispherical.slab, b.hemispherical.slab);
    EXPECT_EQ(a.transmitted.slab, b.transmitted.slab);
    EXPECT_EQ(a.directional[0].slab, b.directional[0].slab);
    EXPECT_EQ(a.directional[0].specular, b.directional[0].specular);
}

TEST(WalkSlabs, Case63NoInterfaceIsThereBetweenDyesOfOneMedium) {
    const std::vector<double> shares{0, 0, 0, .5, 0, 0, .2, .7, 0};
    const LayerStack two{
        {dyed_layer(1.0, {.9, .24, 0}, shares), dyed_layer(1.0, {.6, .16, 0}, shares)},
        LowerFace{}},
        one{{dyed_layer(1.0, {1.5, .4, 0}, shares)}, LowerFace{}};
    const WalkEstimate a = estimate_walk(walk_of(two), direction_deg(30), {}, samples(40000), 3);
    const WalkEstimate b = estimate_walk(walk_of(one), direction_deg(30), {}, samples(40000), 4);
    const auto compare = [](const WalkEstimate& x, const WalkEstimate& y,
                            WalkTally::Parts WalkTally::*side) {
        const Eigen::MatrixXd e = all_errors(y.standard_error.*side), m = all_light(y.mean.*side);
        const SlabTruth truth{{m.data(), m.data() + 9}, {e.data(), e.data() + 9}};
        expect_near(all_light(x.mean.*side).transpose(),
                    all_errors(x.standard_error.*side).transpose(), truth, sidak_bound(18),
                    "two slabs");
    };
    compare(a, b, &WalkTally::hemispherical);
    compare(a, b, &WalkTally::transmitted);
}

TEST(WalkSlabs, WhatCannotBeIsRefused) {
    const LayerStack dyed{{dyed_layer(1.5, {1, 0, 0}, std::vector<double>(9, 0.0))}};
    EXPECT_THROW(LayerWalk(dyed, {.matrix = Eigen::MatrixXd::Zero(3, 3)}, three_bands.centres_nm()),
                 std::invalid_argument);
    const auto refused = [](const LayerWalk& walk, const kernels::Vec3& wi) {
        WalkTally tally = walk.tally(0);
        EXPECT_THROW(walk.eval(wi, {}, 0, 0, tally), std::invalid_argument);
    };
    refused(walk_of(dyed), direction_deg(120));
    refused(walk_of({{{}}, LowerFace{}}), kernels::vec3(1.0, 0.0, 0.0));
    LayerStack rough{{{}}, LowerFace{.alpha = 1.5}};
    EXPECT_THROW(walk_of(rough), Error);
}
