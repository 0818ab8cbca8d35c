#include "kernels/scatter/fresnel.h"
#include "tests/layers/walk_parts.h"
#include "tests/support/directions.h"
#include "tests/support/private_cache.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace reradiant;
using namespace reradiant::test;

namespace {

const PrivateCache cache("walk_sheets");

} // namespace

TEST(WalkSheets, WhiteSheetsSendAllLightToOneOfTheirSides) {
    Layer cloud;
    cloud.alpha = 0.2;
    cloud.scattering_coefficient = Spectrum::constant(2.0);
    cloud.anisotropy = 0.6;
    const LayerStack stack{{cloud, {}}, LowerFace{.alpha = 0.4}};
    const LayerWalk walk = walk_of(stack);
    EXPECT_TRUE(walk.serves_all_bands());
    for (const double theta : {0.0, 89.9, 91.0, 135.0}) {
        const WalkEstimate found = estimate_walk(walk, direction_deg(theta), {}, samples(2048), 3);
        EXPECT_TRUE(column_sums(found.mean).isApproxToConstant(1.0, 1e-12)) << theta;
        EXPECT_GT(found.mean.transmitted.slab(0), 0.1);
    }
}

TEST(WalkSheets, SmoothClearSheetsAreTheSumOfTheirReflections) {
    LayerStack stack{{{}}, LowerFace{}};
    stack.layers[0].absorption = at_three_bands({0.0, 0.3, 2.0});
    const double bound = sidak_bound(12);
    for (const double theta : {35.0, 145.0}) {
        const kernels::Vec3 wi = direction_deg(theta);
        const WalkEstimate found = estimate_walk(walk_of(stack), wi, {}, samples(40000), 5);
        const double c = std::fabs(wi.z), r = kernels::fresnel_dielectric(c, 1.5);
        const Eigen::Vector3d a =
            (-Eigen::Array3d(0.0, 0.3, 2.0) / kernels::fresnel_cos_transmitted(c, 1.5)).exp();
        for (int band = 0; band < 3; ++band) {
            const double passes = (1 - r) * (1 - r) * a(band) / (1 - r * r * a(band) * a(band));
            EXPECT_NEAR(found.mean.transmitted.specular(band), passes,
                        bound * found.standard_error.transmitted.specular(band));
            EXPECT_NEAR(found.mean.hemispherical.specular(band), r + r * a(band) * passes,
                        bound * found.standard_error.hemispherical.specular(band));
        }
        EXPECT_EQ(found.mean.delta, found.mean.hemispherical.specular);
        EXPECT_EQ(found.mean.delta_transmitted, found.mean.transmitted.specular);
    }
}

namespace {

/// Sheets of all that they may hold: rough and smooth faces, clouds, dyes, dispersion, flakes.
std::vector<LayerStack> various_sheets() {
    const std::vector<double> shares{.1, 0, 0, .4, .2, 0, .2, .5, .3};
    Layer rough = dyed_layer(1.5, {1, .4, .1}, shares);
    rough.alpha = 0.3;
    Layer cloud = dyed_layer(1.4, {.5, .2, 0}, shares);
    cloud.scattering_coefficient = Spectrum::constant(1.0);
    cloud.anisotropy = 0.5;
    cloud.absorption = Spectrum::constant(0.1);
    Layer dispersive = dyed_layer(1.5, {.3, 1, .2}, shares);
    dispersive.ior = at_three_bands({1.7, 1.6, 1.5});
    dispersive.alpha = 0.2;
    Layer flaky = cloud;
    flaky.flakes = Flakes{0.3, {}};
    flaky.flakes->reflector.ior = Spectrum::constant(0.3);
    flaky.flakes->reflector.kappa = Spectrum::constant(3.0);
    flaky.flakes->reflector.alpha = 0.3;
    Layer window = {};
    window.absorption = Spectrum::constant(0.2);
    return {{{rough}, LowerFace{}},
            {{cloud}, LowerFace{.alpha = 0.4}},
            {{window, dispersive}, LowerFace{.alpha = 0.1}},
            {{dispersive, flaky}, LowerFace{Distribution::Blinn, 0.3}},
            {{window, window}, LowerFace{.alpha = 0.3}}};
}

} // namespace

TEST(WalkSheets, Case65LightGoesTheSameWayBackThroughASheet) {
    const std::vector<LayerStack> sheets = various_sheets();
    const std::vector<std::pair<double, double>> angles{{20, 125}, {155, 65}, {30, 60}, {100, 150}};
    const double bound = sidak_bound(6.0 * static_cast<double>(sheets.size() * angles.size()));
    std::uint64_t seed = 0;
    for (const LayerStack& sheet : sheets) {
        const LayerWalk walk = walk_of(sheet), reversed = walk.reversed();
        for (const auto& [from, to] : angles) {
            const kernels::Vec3 a = direction_deg(from), b = direction_deg(to, 50);
            const WalkEstimate there = estimate_walk(walk, a, {&b, 1}, samples(10000), ++seed);
            const WalkEstimate back = estimate_walk(reversed, b, {&a, 1}, samples(10000), ++seed);
            const Eigen::MatrixXd x = all_light(there.mean.directional[0]),
                                  y = all_light(back.mean.directional[0]).transpose(),
                                  e = all_errors(there.standard_error.directional[0]),
                                  f = all_errors(back.standard_error.directional[0]).transpose();
            for (int o = 0; o < 3; ++o)
                for (int i = 0; i <= o; ++i)
                    EXPECT_NEAR(x(o, i), y(o, i), bound * std::hypot(e(o, i), f(o, i)) + 1e-12)
                        << "sheet " << seed << ", " << from << " to " << to << ", band " << i
                        << " to " << o;
        }
    }
}

TEST(WalkSheets, Case65DirectionsAddUpToTheHemisphereOfEitherSide) {
    const double bound = sidak_bound(6.0 * 4.0 * 5.0);
    std::uint64_t seed = 0;
    for (const LayerStack& sheet : various_sheets()) {
        const LayerWalk walk = walk_of(sheet);
        for (const double theta : {40.0, 130.0}) {
            const kernels::Vec3 wi = direction_deg(theta);
            const WalkEstimate whole = estimate_walk(walk, wi, {}, samples(20000), ++seed);
            const auto count = static_cast<int>(samples(5000));
            for (const bool is_back : {true, false}) {
                // in directions drawn by their cosine, a new one a walk
                Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3, 3), squares = sum;
                WalkRandom random(++seed, 0, 0);
                for (int k = 0; k < count; ++k) {
                    const double c = std::sqrt(1.0 - random.next()), s = std::sqrt(1.0 - c * c),
                                 phi = 2.0 * std::numbers::pi * random.next();
                    const kernels::Vec3 wo = kernels::vec3(s * std::cos(phi), s * std::sin(phi),
                                                           is_back == (wi.z > 0.0) ? c : -c);
                    WalkTally tally = walk.tally(1);
                    walk.eval(wi, {&wo, 1}, seed, static_cast<std::uint64_t>(k), tally);
                    const Eigen::MatrixXd flux = std::numbers::pi * all_light(tally.directional[0]);
                    sum += flux / count;
                    squares += flux.cwiseAbs2() / count;
                }
                const WalkTally &mean = whole.mean, &error = whole.standard_error;
                Eigen::MatrixXd expected =
                    all_light(is_back ? mean.hemispherical : mean.transmitted);
                expected -=
                    Eigen::MatrixXd((is_back ? mean.delta : mean.delta_transmitted).asDiagonal());
                const Eigen::MatrixXd e =
                    all_errors(is_back ? error.hemispherical : error.transmitted);
                for (int o = 0; o < 3; ++o)
                    for (int i = 0; i <= o; ++i) {
                        const double variance =
                            (squares(o, i) - sum(o, i) * sum(o, i)) / count + e(o, i) * e(o, i);
                        EXPECT_NEAR(sum(o, i), expected(o, i), bound * std::sqrt(variance) + 1e-12)
                            << theta << " " << is_back << ", band " << i << " to " << o
                            << ", sheet " << (seed - 1) / 6;
                    }
            }
        }
    }
}
