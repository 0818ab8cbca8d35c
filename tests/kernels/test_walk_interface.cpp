#include "kernels/walk/walk_chance.h"
#include "kernels/walk/walk_interface.h"
#include "kernels/walk/walk_microsurface.h"
#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

#include <numbers>

namespace reradiant {
namespace {

using namespace test;
using kernels::vec3;
using kernels::Vec3;
using kernels::WalkSurface;

WalkSurface surface_of(int distribution, double alpha, double eta, bool multiple = true) {
    return {distribution, alpha, eta, multiple ? 1 : 0, 0, nullptr};
}

TEST(KernelWalk, FacetsMatchDouble) {
    Source source(23);
    std::vector<float> input;
    constexpr std::size_t count = 50000;
    for (std::size_t i = 0; i < count; ++i) {
        const double eta = source.uniform(1.1, 2.4);
        input.push_back(i % 2 ? MICROFACET_GGX : MICROFACET_BECKMANN);
        input.push_back(static_cast<float>(source.uniform(0.1, 1.0)));
        input.push_back(static_cast<float>(i % 4 < 2 ? eta : 1.0 / eta));
        source.push_direction(input);
        if (i % 8 == 7) // a view from between the facets, a little below the horizon
            input.back() *= -0.2f;
        source.push_direction(input);
        input.push_back(static_cast<float>(source.uniform(1e-3, 0.999)));
        input.push_back(static_cast<float>(source.uniform(0.0, 1.0)));
    }
    const std::vector<float> found = run_probe("probe_walk_facets", input, count, 6);
    for (std::size_t i = 0; i < count; ++i) {
        const float* p = input.data() + 11 * i;
        const float* out = found.data() + 6 * i;
        const WalkSurface surface = surface_of(static_cast<int>(p[0]), p[1], p[2]);
        const Vec3 v = vec3(p[3], p[4], p[5]), w = vec3(p[6], p[7], p[8]);
        const Vec3 h = walk_half_reflected(v, w);
        const kernels::WalkRefraction r = walk_refraction(surface, v, walk_mirrored(w));
        // beckmann's area below the horizon is a difference; densities stand over it
        const double bound = v.z < 0.0 ? 2e-2 : 1e-3;
        const double escape = walk_escape(surface, w, p[9]);
        EXPECT_LT(relative_difference(out[0], walk_visible_area(surface, v), 1e-4), bound);
        EXPECT_LT(relative_difference(out[1], walk_reflection_density(surface, v, h, 1.0), 1e-2),
                  bound)
            << i;
        EXPECT_LT(relative_difference(out[2], walk_refraction_density(surface, v, r, 1.0), 1e-2),
                  bound)
            << i;
        EXPECT_NEAR(out[3], escape, 1e-4) << i;
        if (std::abs(p[10] - escape) > 1e-4) {
            const double height = walk_next_height(surface, w, p[9], p[10]);
            EXPECT_LT(relative_difference(out[4], height, 1e-3), 1e-3) << i;
        }
        const double met = walk_met_height(surface, w, p[9], p[10]);
        EXPECT_LT(relative_difference(out[5], met, 1e-3), 1e-3) << i;
    }
}

/// A ray that stays is one that did not leave: both functions of heights say the same of it.
TEST(KernelWalk, MetHeightsAreNextHeightsOfRaysThatStay) {
    Source source(31);
    for (int i = 0; i < 10000; ++i) {
        const WalkSurface surface =
            surface_of(i % 2 ? MICROFACET_GGX : MICROFACET_BECKMANN, source.uniform(0.1, 1.0), 1.5);
        std::vector<float> direction;
        source.push_direction(direction);
        const Vec3 w = vec3(direction[0], direction[1], i % 3 ? direction[2] : -direction[2]);
        const double height = source.uniform(1e-3, 0.999), u = source.uniform(0.0, 1.0);
        const double escape = walk_escape(surface, w, height);
        // where nearly all leave, 1 - u * stays has lost the digits of what stays
        if (escape > 0.999)
            continue;
        const double next =
            walk_next_height(surface, w, height, w.z > 0.0 ? 1.0 - u * (1.0 - escape) : u);
        EXPECT_NEAR(walk_met_height(surface, w, height, u), next, 1e-9) << i;
        EXPECT_LT(next, 1.0);
    }
}

Vec3 at_angle(double degrees) {
    const double theta = degrees * std::numbers::pi / 180.0;
    return vec3(std::sin(theta), 0.0, std::cos(theta));
}

/// Share of walks that pass, and what is left of all.
struct Shares {
    double passed = 0.0, all = 0.0;
};
Shares shares_of(const WalkSurface& surface, const Vec3& v, std::uint32_t count) {
    Shares shares;
    for (std::uint32_t i = 0; i < count; ++i) {
        kernels::WalkRandom random = kernels::walk_random(i, 0, 0, 5);
        const kernels::WalkDeparture departure =
            walk_interface(surface, v, kernels::walk_no_targets(), &random);
        shares.passed += departure.passed ? departure.weight / count : 0.0;
        shares.all += departure.weight / count;
    }
    return shares;
}

TEST(KernelWalk, MultipleScatteringHasTheSharesOfAnIndependentWalk) {
    // n 1.5, alpha 0.3: figures of a microsurface walk written on its own, to four digits
    const WalkSurface surface = surface_of(MICROFACET_GGX, 0.3, 1.5);
    constexpr std::uint32_t count = 200000;
    for (const auto& [degrees, transmitted] :
         {std::pair{0.0, 0.9634}, {45.0, 0.9542}, {80.0, 0.8661}}) {
        const Shares found = shares_of(surface, at_angle(degrees), count);
        EXPECT_NEAR(found.all, 1.0, 1e-9);
        const double error = std::sqrt(transmitted * (1.0 - transmitted) / count);
        EXPECT_NEAR(found.passed, transmitted, 5.5 * error + 1e-4) << degrees;
    }
}

/// What a passage makes of a bundle of directions on the way up, it undoes on the way down: the
/// ratio of the two densities is the one by which chance below counts in air.
TEST(KernelWalk, PassagesUpAndDownDifferByTheBundleOfDirections) {
    Source source(41);
    int passages = 0;
    for (int i = 0; i < 20000; ++i) {
        const double ior = source.uniform(1.1, 2.4);
        const WalkSurface above = surface_of(i % 3, source.uniform(0.1, 0.9), ior, false);
        std::vector<float> numbers;
        source.push_direction(numbers);
        source.push_direction(numbers);
        const Vec3 air = kernels::vec3_normalise(vec3(numbers[0], numbers[1], numbers[2]));
        const Vec3 below = kernels::vec3_normalise(vec3(numbers[3], numbers[4], numbers[5]));
        const double down = walk_single_density(above, air, below, 1);
        const double up = walk_single_density(walk_from_beyond(above), below, air, 1);
        if (below.z < 1e-6)
            continue;
        const double ratio = air.z * kernels::walk_chance_below(1.0, ior, below.z);
        EXPECT_LT(relative_difference(up, ratio * down, 1e-12), 1e-6) << i;
        passages += up > 1e-3;
    }
    EXPECT_GT(passages, 2000);
}

/// Densities towards uniform directions integrate to the shares that are sampled: value and
/// sampling are of one function. 200000 draws of each see 1 % at the bound.
void expect_densities_integrate(const WalkSurface& surface, double degrees) {
    const Vec3 v = at_angle(degrees);
    constexpr std::uint32_t count = 200000;
    Source source(29);
    double same = 0.0, beyond = 0.0, same2 = 0.0, beyond2 = 0.0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto uniform_direction = [&] {
            const double z = source.uniform(0.0, 1.0), s = std::sqrt(1.0 - z * z);
            const double phi = source.uniform(0.0, 2.0 * std::numbers::pi);
            return vec3(s * std::cos(phi), s * std::sin(phi), z);
        };
        const kernels::WalkTargets targets = {uniform_direction(), uniform_direction(), 1, 1};
        kernels::WalkRandom random = kernels::walk_random(i, 1, 0, 5);
        const kernels::WalkDeparture d = walk_interface(surface, v, targets, &random);
        same += d.same_density;
        beyond += d.beyond_density;
        same2 += d.same_density * d.same_density;
        beyond2 += d.beyond_density * d.beyond_density;
    }
    const Shares sampled = shares_of(surface, v, count);
    const double area = 2.0 * std::numbers::pi / count;
    const double reflected = sampled.all - sampled.passed;
    // weights of V-cavities reach 2
    const auto bound = [&](double squares, double share) {
        return 5.5 * (area * std::sqrt(squares) + std::sqrt(2.0 * share / count));
    };
    EXPECT_NEAR(area * same, reflected, bound(same2, reflected)) << degrees << ' ' << surface.eta;
    EXPECT_NEAR(area * beyond, sampled.passed, bound(beyond2, sampled.passed))
        << degrees << ' ' << surface.eta;
}

TEST(KernelWalk, DensitiesIntegrateToTheSampledShares) {
    for (const double eta : {1.5, 1.0 / 1.5})
        for (const double degrees : {20.0, 65.0}) {
            expect_densities_integrate(surface_of(MICROFACET_GGX, 0.5, eta), degrees);
            expect_densities_integrate(surface_of(MICROFACET_BECKMANN, 0.4, eta), degrees);
            expect_densities_integrate(surface_of(MICROFACET_GGX, 0.5, eta, false), degrees);
            expect_densities_integrate(surface_of(MICROFACET_BLINN, 0.4, eta, false), degrees);
        }
}

} // namespace
} // namespace reradiant
