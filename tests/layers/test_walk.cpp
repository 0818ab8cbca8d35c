#include "host/layers/stack/quadrature.h"
#include "host/layers/walk/walk_estimate.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/henyey_greenstein.h"
#include "kernels/scatter/microfacet.h"
#include "kernels/scatter/oren_nayar.h"
#include "kernels/scatter/thin_film.h"
#include "reradiant/error.h"
#include "tests/layers/layer_values.h"
#include "tests/layers/walk_stacks.h"
#include "tests/support/full_run.h"
#include "tests/support/private_cache.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <array>

using namespace reradiant;

namespace {

const test::PrivateCache cache("walk");

std::uint64_t samples(std::uint64_t count) {
    return test::is_full_run() ? 16 * count : count;
}

LayerStack dispersive_stack() {
    LayerStack stack{{plain_layer(1.5, 0.2, 0.1), plain_layer(1.6, 0.0, 0.0)}};
    stack.layers[1].ior = Spectrum::table({400, 600}, {1.9, 1.6});
    stack.layers[1].absorption = Spectrum::table({400, 600}, {0.3, 0.1});
    return stack;
}

WalkEstimate estimate(const LayerStack& stack, const kernels::Vec3& wi, const kernels::Vec3& wo,
                      std::uint64_t count, std::uint64_t seed) {
    const LayerWalk walk(stack, {.matrix = bispectral_matrix()}, two_bands_nm);
    return estimate_walk(walk, wi, {&wo, 1}, count, seed);
}

double whole_albedo(const WalkTally& tally) {
    const WalkTally::Parts& parts = tally.hemispherical;
    return parts.diffuse(0) + parts.slab(0) + parts.specular(0);
}

/// Compares three diffuse entries and the specular albedo.
void expect_adding(const LayerStack& stack, double comparisons, std::uint64_t count,
                   std::uint64_t seed) {
    const kernels::Vec3 wi = test::direction_deg(35, 0), wo = test::direction_deg(60, 70);
    const WalkEstimate walk = estimate(stack, wi, wo, count, seed);
    const AddingValues adding = adding_values(stack, wi, wo);
    const double bound = test::sidak_bound(comparisons);
    const auto compare = [&](double found, double error, double expected, const char* what) {
        // 0.15 %: cells of direction and the sampled tables of rough interfaces
        EXPECT_NEAR(found, expected, bound * error + 1.5e-3 * expected) << what << " " << seed;
        EXPECT_LE(error, 0.03 * expected) << what << " " << seed;
    };
    const auto& mean = walk.mean.directional[0].diffuse;
    const auto& error = walk.standard_error.directional[0].diffuse;
    compare(mean(0, 0), error(0, 0), adding.diffuse(0, 0), "400");
    compare(mean(1, 0), error(1, 0), adding.diffuse(1, 0), "400 to 600");
    compare(mean(1, 1), error(1, 1), adding.diffuse(1, 1), "600");
    EXPECT_EQ(mean(0, 1), 0.0);
    const WalkTally::Parts &whole = walk.mean.hemispherical,
                           &whole_error = walk.standard_error.hemispherical;
    compare(whole.specular(0) + whole.slab(0),
            std::hypot(whole_error.specular(0), whole_error.slab(0)), adding.specular_albedo(0),
            "not from the substrate");
}

} // namespace

TEST(Walk, AgreesWithAddingOverABispectralSubstrate) {
    const std::vector<LayerStack> stacks{
        {},
        {{plain_layer(1.5, 0.0, 0.3)}},
        {{plain_layer(1.5, 0.3, 0.2)}},
        {{plain_layer(1.5, 0.6, 0.0, Scattering::Single)}},
        {{plain_layer(1.5, 0.3, 0.2, Scattering::Multiple, Distribution::Beckmann)}},
        {{plain_layer(1.5, 0.3, 0.2, Scattering::Multiple, Distribution::Blinn)}},
        {{plain_layer(2.4, 0.1, 1.0), plain_layer(1.2, 0.4, 0.0)}},
        {{plain_layer(1.2, 0.0, 0.0), plain_layer(1.8, 0.2, 0.1), plain_layer(1.5, 0.0, 0.1)}},
        {{cloudy_layer(1.5, 0.0, 0.1, 1.0, 0.5)}},
        {{cloudy_layer(1.5, 0.2, 0.1, 1.0, -0.4), plain_layer(1.8, 0.0, 0.1)}},
    };
    const auto comparisons = static_cast<double>(4 * stacks.size());
    for (std::size_t k = 0; k < stacks.size(); ++k)
        expect_adding(stacks[k], comparisons, samples(40000), k);
}

TEST(Walk, DispersiveStacksShiftTheirPathsWithTheWavelength) {
    const LayerStack stack = dispersive_stack();
    EXPECT_FALSE(
        LayerWalk(stack, {.matrix = bispectral_matrix()}, two_bands_nm).serves_all_bands());
    expect_adding(stack, 4, samples(60000), 11);
}

TEST(Walk, Case29ReversedLightHasTheSameValue) {
    LayerStack flaky = dispersive_stack();
    Conductor flake;
    flake.ior = Spectrum::constant(0.2);
    flake.kappa = Spectrum::constant(3.0);
    flake.alpha = 0.3;
    flaky.layers[1].flakes = Flakes{0.3, flake};
    const std::vector<LayerStack> stacks{
        dispersive_stack(),
        flaky,
        {{cloudy_layer(1.5, 0.2, 0.1, 1.0, 0.6), plain_layer(1.2, 0.3, 0.0)}},
        {{plain_layer(1.5, 0.4, 0.1, Scattering::Multiple, Distribution::Blinn)}},
    };
    const kernels::Vec3 a = test::direction_deg(20, 0), b = test::direction_deg(65, 50);
    const double bound = test::sidak_bound(7.0 * static_cast<double>(stacks.size()));
    for (std::size_t k = 0; k < stacks.size(); ++k) {
        const LayerWalk walk(stacks[k], {.matrix = bispectral_matrix()}, two_bands_nm);
        const WalkEstimate there = estimate_walk(walk, a, {&b, 1}, samples(40000), 2 * k);
        const WalkEstimate back =
            estimate_walk(walk.reversed(), b, {&a, 1}, samples(40000), 2 * k + 1);
        const auto compare = [&](double x, double x_error, double y, double y_error) {
            // a lobe without randomness is as exact as its rounding
            EXPECT_NEAR(x, y, bound * std::hypot(x_error, y_error) + 1e-12 * x) << k;
        };
        const auto &m = there.mean.directional[0], &n = back.mean.directional[0];
        const auto &e = there.standard_error.directional[0],
                   &f = back.standard_error.directional[0];
        for (const auto& [o, i] : {std::pair{0, 0}, {1, 0}, {1, 1}})
            compare(m.diffuse(o, i), e.diffuse(o, i), n.diffuse(i, o), f.diffuse(i, o));
        for (const int band : {0, 1}) {
            compare(m.specular(band), e.specular(band), n.specular(band), f.specular(band));
            compare(m.slab(band), e.slab(band), n.slab(band), f.slab(band));
        }
    }
}

TEST(Walk, SamplesAreWhereEvalSaysThatLightGoes) {
    LayerStack stack{{cloudy_layer(1.5, 0.4, 0.1, 0.5, 0.3), plain_layer(1.3, 0.3, 0.0)}};
    const LayerWalk walk(stack, {.matrix = bispectral_matrix()}, two_bands_nm);
    const kernels::Vec3 wi = test::direction_deg(50, 0);
    constexpr int rings = 3, halves = 2, regions = rings * halves;
    const auto count = static_cast<int>(samples(60000));
    // flux by region and band of light that comes at 400 nm, and its squares
    std::array<std::array<double, 2>, regions> sampled{}, squares{};
    WalkRandom random(4, 0, 0);
    for (int k = 0; k < count; ++k) {
        const WalkSample found = walk.sample(wi, 0, random);
        if (found.weight > 0.0) {
            const int ring = std::min(static_cast<int>(found.w.z * rings), rings - 1);
            const int place = ring * halves + (found.w.x < 0.0);
            const auto region = static_cast<std::size_t>(place);
            const auto band = static_cast<std::size_t>(found.band);
            sampled[region][band] += found.weight / count;
            squares[region][band] += found.weight * found.weight / count;
        }
    }
    for (int region = 0; region < regions; ++region) {
        // eval in directions drawn evenly from the region, a new one a walk
        std::array<double, 2> sum{}, square{};
        const int draws = count / 6, ring = region / halves;
        for (int k = 0; k < draws; ++k) {
            const double c = (ring + random.next()) / rings;
            const double phi = 180.0 * (random.next() - 0.5 + region % halves);
            const kernels::Vec3 wo = test::direction_deg(std::acos(c) * 180.0 / M_PI, phi);
            WalkTally tally = walk.tally(1);
            walk.eval(wi, {&wo, 1}, 9, static_cast<std::uint64_t>(k), tally);
            for (const Eigen::Index band : {0, 1}) {
                const WalkTally::Parts& parts = tally.directional[0];
                const double value =
                    parts.diffuse(band, 0) + (band == 0 ? parts.specular(0) + parts.slab(0) : 0.0);
                const double flux = value * c * 2.0 * M_PI / regions;
                sum[static_cast<std::size_t>(band)] += flux / draws;
                square[static_cast<std::size_t>(band)] += flux * flux / draws;
            }
        }
        for (const std::size_t band : {0U, 1U}) {
            const auto r = static_cast<std::size_t>(region);
            const double a = sampled[r][band], b = sum[band];
            const double error =
                std::sqrt((squares[r][band] - a * a) / count + (square[band] - b * b) / draws);
            EXPECT_NEAR(a, b, test::sidak_bound(2.0 * regions) * error) << region << " " << band;
            EXPECT_GT(a, 0.0);
        }
    }
}

TEST(Walk, WhiteStacksOfMultipleScatteringReflectEverything) {
    Conductor mirror; // n + i k almost without a real part reflects everything
    mirror.ior = Spectrum::constant(1e-14);
    mirror.kappa = Spectrum::constant(1.0);
    mirror.alpha = 0.4;
    for (const Distribution distribution :
         {Distribution::Ggx, Distribution::Beckmann, Distribution::Blinn}) {
        for (const double n : {1.2, 2.4}) {
            for (const double alpha : {0.02, 0.6}) {
                LayerStack stack{
                    {plain_layer(n, alpha, 0.0, Scattering::Multiple, distribution),
                     cloudy_layer(1.5, 0.0, 0.0, 0.5, 0.3),
                     plain_layer(1.5 * n, alpha, 0.0, Scattering::Multiple, distribution)}};
                mirror.distribution = distribution;
                stack.layers[2].flakes = Flakes{0.2, mirror};
                const LayerWalk walk(stack, {.matrix = Eigen::MatrixXd::Identity(1, 1)}, {550.0});
                for (const double theta : {0.0, 80.0}) {
                    const WalkEstimate found =
                        estimate_walk(walk, test::direction_deg(theta, 0), {}, samples(2048), 5);
                    const double albedo = whole_albedo(found.mean);
                    // exact but for blinn, whose single scattering is weighted
                    const double tolerance =
                        distribution == Distribution::Blinn
                            ? 5e-3 + test::sidak_bound(8) *
                                         std::hypot(found.standard_error.hemispherical.diffuse(0),
                                                    found.standard_error.hemispherical.specular(0))
                            : 1e-12;
                    EXPECT_NEAR(albedo, 1.0, tolerance)
                        << n << " " << alpha << " " << theta << " " << tolerance;
                }
            }
        }
    }
}

TEST(Walk, SingleScatteringLosesWhatIsKnown) {
    // clear GGX coats of n = 1.5 over white, from an independent random walk
    for (const auto& [alpha, loss] : {std::pair{0.1, 0.074}, {0.3, 0.296}, {0.6, 0.497}}) {
        const LayerWalk walk({{plain_layer(1.5, alpha, 0.0, Scattering::Single)}},
                             {.matrix = Eigen::MatrixXd::Identity(1, 1)}, {550.0});
        const WalkEstimate found =
            estimate_walk(walk, test::direction_deg(0, 0), {}, samples(60000), 3);
        const double albedo = whole_albedo(found.mean);
        const double error = std::hypot(found.standard_error.hemispherical.diffuse(0),
                                        found.standard_error.hemispherical.specular(0));
        EXPECT_NEAR(1.0 - albedo, loss, test::sidak_bound(3) * error + 1e-3) << alpha; // 3 digits
    }
}

TEST(Walk, FilmsAndMetalsHaveTheirClosedForms) {
    const kernels::Vec3 wi = test::direction_deg(40, 0), wo = test::direction_deg(50, 170);
    LayerStack filmed{{plain_layer(1.5, 0.0, 0.0)}};
    filmed.layers[0].film = ThinFilm{320.0, Spectrum::constant(2.0)};
    const LayerWalk film(filmed, {.matrix = Eigen::MatrixXd::Zero(2, 2)}, two_bands_nm);
    EXPECT_FALSE(film.serves_all_bands());
    const WalkEstimate mirrored = estimate_walk(film, wi, {}, samples(20000), 1);
    for (const int band : {0, 1}) {
        const double expected = kernels::thin_film_reflectance(
            wi.z, 1.0, 2.0, 1.5, 0.0, 320.0, two_bands_nm[static_cast<std::size_t>(band)]);
        EXPECT_NEAR(mirrored.mean.hemispherical.specular(band), expected,
                    test::sidak_bound(2) * mirrored.standard_error.hemispherical.specular(band));
        EXPECT_EQ(mirrored.mean.delta(band), mirrored.mean.hemispherical.specular(band));
    }
    for (const Distribution distribution : {Distribution::Ggx, Distribution::Blinn}) {
        const SurfaceValues metal =
            conductor_values(0.3, 3.0, distribution, 0.3, Scattering::Single);
        const LayerWalk bare({}, {.matrix = {}, .conductor = {metal}}, {550.0});
        const WalkEstimate lobe = estimate_walk(bare, wi, {&wo, 1}, 256, 1);
        const kernels::Vec3 h = kernels::vec3_normalise(kernels::vec3_add(wi, wo));
        const double expected =
            kernels::fresnel_conductor(kernels::vec3_dot(wi, h), 0.3, 3.0) *
            kernels::microfacet_reflection(kernel_distribution(distribution), 0.3, wi, wo);
        EXPECT_NEAR(lobe.mean.directional[0].diffuse(0), expected, 1e-12 * expected);
    }
}

TEST(Walk, SmoothFlakesReflectTheirShare) {
    Conductor metal;
    metal.ior = Spectrum::constant(0.3);
    metal.kappa = Spectrum::constant(3.0);
    LayerStack stack{{plain_layer(1.0, 0.0, 0.2)}};
    stack.layers[0].flakes = Flakes{0.4, metal};
    const LayerWalk walk(stack, {.matrix = Eigen::MatrixXd::Identity(1, 1)}, {550.0});
    const kernels::Vec3 wi = test::direction_deg(30, 0), wo = test::direction_deg(45, 0);
    const WalkEstimate found = estimate_walk(walk, wi, {&wo, 1}, samples(40000), 2);
    const double a = std::exp(-0.2 / wi.z), r = kernels::fresnel_conductor(wi.z, 0.3, 3.0);
    EXPECT_NEAR(found.mean.hemispherical.specular(0), 0.4 * r * a * a,
                test::sidak_bound(2) * found.standard_error.hemispherical.specular(0));
    // between the white substrate and the flakes' undersides
    const double back = 2.0 * integrate_sin2(0.0, 1.0, 64, [](double c) {
                            return c * 0.4 * kernels::fresnel_conductor(c, 0.3, 3.0);
                        });
    const double through = 0.6 * a * 0.6 * std::exp(-0.2 / wo.z);
    EXPECT_NEAR(found.mean.directional[0].diffuse(0), through / (std::numbers::pi * (1.0 - back)),
                test::sidak_bound(2) * found.standard_error.directional[0].diffuse(0));
}

TEST(Walk, OrenNayarIsItsFormulaAndSeesTheSlabsDirections) {
    const kernels::Vec3 wi = test::direction_deg(60, 0), wo = test::direction_deg(70, 20);
    const auto mean = [&](const LayerStack& stack) {
        const LayerWalk walk(stack, {.matrix = Eigen::MatrixXd::Constant(1, 1, 0.01), .sigma = 0.4},
                             {550.0});
        return estimate_walk(walk, wi, {&wo, 1}, samples(20000), 2);
    };
    const WalkEstimate bare = mean({});
    EXPECT_NEAR(bare.mean.directional[0].diffuse(0), 0.01 * kernels::oren_nayar_value(0.4, wi, wo),
                1e-14);
    // black enough that the first bounce is all but 1 %
    const LayerStack coat{{plain_layer(1.5, 0.0, 0.0)}};
    const auto inside = [](const kernels::Vec3& w) {
        return kernels::vec3(w.x / 1.5, w.y / 1.5, kernels::fresnel_cos_transmitted(w.z, 1.5));
    };
    const double first = 0.01 * kernels::oren_nayar_value(0.4, inside(wi), inside(wo)) / 2.25 *
                         (1.0 - kernels::fresnel_dielectric(wi.z, 1.5)) *
                         (1.0 - kernels::fresnel_dielectric(wo.z, 1.5));
    const WalkEstimate coated = mean(coat);
    EXPECT_NEAR(coated.mean.directional[0].diffuse(0), first,
                0.01 * first + 5.0 * coated.standard_error.directional[0].diffuse(0));
}

TEST(Walk, EstimatesDoNotDependOnThreads) {
    const kernels::Vec3 wi = test::direction_deg(35, 0), wo = test::direction_deg(60, 70);
    const LayerStack stack = dispersive_stack();
    WalkEstimate one, two;
    tbb::task_arena(1).execute([&] { one = estimate(stack, wi, wo, 2000, 7); });
    tbb::task_arena(2).execute([&] { two = estimate(stack, wi, wo, 2000, 7); });
    EXPECT_EQ(one.mean.directional[0].diffuse, two.mean.directional[0].diffuse);
    EXPECT_EQ(one.standard_error.hemispherical.diffuse, two.standard_error.hemispherical.diffuse);
    const WalkEstimate other = estimate(stack, wi, wo, 2000, 8);
    EXPECT_NE(one.mean.directional[0].diffuse, other.mean.directional[0].diffuse);
}

TEST(Walk, Case12HenyeyGreensteinKeepsItsMeanCosine) {
    const kernels::Vec3 d = kernels::vec3_normalise(kernels::vec3(0.3, -0.5, 0.2));
    for (const double g : {-0.9, -0.3, 0.0, 1e-9, 0.5, 0.99, 0.9999}) {
        WalkRandom random(1, 2, 3);
        const int count = 20000;
        double sum = 0.0, squares = 0.0;
        for (int k = 0; k < count; ++k) {
            const double u1 = random.next(), u2 = random.next();
            const double mu = kernels::vec3_dot(d, kernels::henyey_greenstein_sample(d, g, u1, u2));
            sum += mu;
            squares += mu * mu;
        }
        const double mean = sum / count;
        const double error = std::sqrt((squares / count - mean * mean) / count);
        EXPECT_NEAR(mean, g, test::sidak_bound(7) * error) << g;
        EXPECT_TRUE(std::isfinite(kernels::henyey_greenstein_phase(g, 1.0)));
    }
    EXPECT_NEAR(kernels::henyey_greenstein_phase(0.9999, 1.0), 1.9999e8 / (4.0 * M_PI * 1.0), 1.0);
}

TEST(Walk, WhatCannotBeIsRefused) {
    const auto refused = [](const LayerStack& stack, const SubstrateValues& substrate) {
        EXPECT_THROW(LayerWalk(stack, substrate, two_bands_nm), Error);
    };
    const SubstrateValues good{.matrix = bispectral_matrix()};
    refused({{plain_layer(-1.0, 0.0, 0.0)}}, good);
    refused({{plain_layer(1.5, 1.5, 0.0)}}, good);
    refused({{plain_layer(1.5, 0.0, -1.0)}}, good);
    refused({{cloudy_layer(1.5, 0.0, 0.0, 1.0, 1.0)}}, good);
    refused({}, {.matrix = Eigen::MatrixXd::Identity(3, 3)});
    refused({}, {.matrix = -bispectral_matrix()});
    const LayerWalk walk({}, good, two_bands_nm);
    WalkTally tally = walk.tally(0);
    EXPECT_THROW(walk.eval(test::direction_deg(100, 0), {}, 0, 0, tally), std::invalid_argument);
}
