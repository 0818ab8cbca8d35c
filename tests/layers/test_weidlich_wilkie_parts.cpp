#include "host/layers/models/weidlich_wilkie.h"
#include "host/layers/models/weidlich_wilkie_residual.h"
#include "host/layers/rough/facet_interreflection.h"
#include "host/layers/rough/facet_reflectance.h"
#include "host/layers/walk/walk_estimate.h"
#include "tests/layers/layer_values.h"
#include "tests/support/directions.h"
#include "tests/support/private_cache.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

using namespace reradiant;
using kernels::Vec3;

namespace {

const test::PrivateCache cache("weidlich-wilkie-parts");

double cos_deg(double degrees) {
    return std::cos(degrees * M_PI / 180.0);
}

/// Fresnel by complex numbers, for any index relative to the medium of incidence.
double fresnel(double c, std::complex<double> n) {
    const std::complex<double> q = std::sqrt(n * n - (1.0 - c * c));
    const std::complex<double> s = (c - q) / (c + q), p = (n * n * c - q) / (n * n * c + q);
    return 0.5 * (std::norm(s) + std::norm(p));
}

/// Gold's numbers near 550 nm.
const SurfaceValues gold = conductor_values(0.42, 2.35, Distribution::Ggx, 0.3, Scattering::Single);
/// Reflects all but 1e-6 at any angle: IOR 0.
const SurfaceValues perfect = conductor_values(1e-9, 5.0, Distribution::Ggx, 0.4);
const std::complex<double> gold_index{0.42, 2.35};

SurfaceValues smoothed(SurfaceValues c) {
    c.alpha = 0.0;
    return c;
}
LayerValues slab(double ior, double tau = 0.0, double tau_scattering = 0.0, double g = 0.0) {
    LayerValues layer{ior, Distribution::Ggx, 0.0, Scattering::Single, tau};
    layer.tau_scattering = tau_scattering;
    layer.anisotropy = g;
    return layer;
}
LayerValues rough(double ior, double alpha, Distribution d = Distribution::Ggx,
                  Scattering s = Scattering::Multiple) {
    return {ior, d, alpha, s, 0.0};
}

/// Hemispherical share of f(wi, wo) by the midpoint rule over half vectors, 400 x 200.
template <typename Function>
double albedo(const Function& f, const Vec3& wi) {
    const int rings = 400, sectors = 200;
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < sectors; ++k) {
            const double theta = 90.0 * (i + 0.5) / rings;
            const Vec3 h = test::direction_deg(theta, 360.0 * (k + 0.5) / sectors);
            const double c = kernels::vec3_dot(wi, h);
            const Vec3 wo = kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * c), wi);
            if (c > 0.0 && wo.z > 0.0)
                sum += f(wi, wo) * wo.z * 4.0 * c * std::sin(theta * M_PI / 180.0);
        }
    }
    return sum * (0.5 * M_PI / rings) * (2.0 * M_PI / sectors);
}

} // namespace

TEST(WeidlichWilkieParts, Case17BareConductorIsTorranceAndSparrow) {
    const Vec3 wi = test::direction_deg(50, 0), wo = test::direction_deg(35, 150);
    const Vec3 sum = kernels::vec3_add(wi, wo);
    const double length = std::sqrt(kernels::vec3_dot(sum, sum));
    const double cos_h = sum.z / length, vdoth = kernels::vec3_dot(wi, sum) / length;
    const double a2 = 0.09, q = cos_h * cos_h * (a2 - 1.0) + 1.0;
    const auto lambda = [&](double c) {
        return 0.5 * (std::sqrt(1.0 + a2 * (1.0 / (c * c) - 1.0)) - 1.0);
    };
    const double d = a2 / (M_PI * q * q), g = 1.0 / (1.0 + lambda(wi.z) + lambda(wo.z));
    EXPECT_NEAR(WeidlichWilkie::conductor(stack_of({}, gold), wi, wo),
                fresnel(vdoth, gold_index) * d * g / (4 * wi.z * wo.z), 1e-12);
    EXPECT_EQ(WeidlichWilkie::conductor_delta(stack_of({}, gold), 0.5), 0.0);
    EXPECT_EQ(WeidlichWilkie::specular(stack_of({}), wi, wo), 0.0);
}

TEST(WeidlichWilkieParts, Case17SmoothConductorUnderASmoothLayerIsTwoMirrors) {
    const double tau = 0.2, n = 1.5;
    for (const double theta : {0.0, 40.0, 80.0}) {
        const double c = cos_deg(theta), inner = std::sqrt(n * n - 1.0 + c * c) / n;
        const double through = std::pow((1.0 - fresnel(c, n)) * std::exp(-tau / inner), 2);
        EXPECT_NEAR(WeidlichWilkie::conductor_delta(stack_of({slab(n, tau)}, smoothed(gold)), c),
                    through * fresnel(inner, gold_index / n), 1e-12)
            << theta;
        EXPECT_NEAR(WeidlichWilkie::specular_delta(stack_of({slab(n, tau)}), c), fresnel(c, n),
                    1e-12);
    }
    EXPECT_EQ(WeidlichWilkie::conductor(stack_of({}, smoothed(gold)), test::direction_deg(20, 0),
                                        test::direction_deg(20, 180)),
              0.0);
}

TEST(WeidlichWilkieParts, FilmOfNoThicknessIsNone) {
    LayerValues bare = rough(1.6, 0.2, Distribution::Beckmann, Scattering::Single), film = bare;
    film.film = {0.0, 1.3};
    film.wavelength_nm = 500.0;
    SurfaceValues coated = gold;
    coated.film = {0.0, 1.3};
    coated.wavelength_nm = 500.0;
    const Vec3 wi = test::direction_deg(30, 0), wo = test::direction_deg(55, 100);
    EXPECT_EQ(WeidlichWilkie::specular(stack_of({film}), wi, wo),
              WeidlichWilkie::specular(stack_of({bare}), wi, wo));
    EXPECT_EQ(WeidlichWilkie::way_in(stack_of({film}), wi, wo),
              WeidlichWilkie::way_in(stack_of({bare}), wi, wo));
    EXPECT_EQ(WeidlichWilkie::conductor(stack_of({bare}, coated), wi, wo),
              WeidlichWilkie::conductor(stack_of({bare}, gold), wi, wo));
}

TEST(WeidlichWilkieParts, QuarterWaveFilmIsTheKnownCoating) {
    LayerValues glass = slab(1.52);
    glass.film = {550.0 / (4.0 * 1.38), 1.38};
    glass.wavelength_nm = 550.0;
    // (n - nf^2)^2 / (n + nf^2)^2, textbook
    const double r = std::pow((1.52 - 1.38 * 1.38) / (1.52 + 1.38 * 1.38), 2);
    EXPECT_NEAR(WeidlichWilkie::specular_delta(stack_of({glass}), 1.0), r, 1e-12);
    const Vec3 up = test::direction_deg(0, 0);
    EXPECT_NEAR(WeidlichWilkie::way_in(stack_of({glass}), up, up), 1.0 - r, 1e-12);
    EXPECT_NEAR(WeidlichWilkie::way_out(stack_of({glass}), up, up), 1.0 - r, 1e-12);
}

TEST(WeidlichWilkieParts, FlakesReflectTheirShareAndLetTheRestPass) {
    LayerValues paint = slab(1.5, 0.1);
    paint.flake_coverage = 0.3;
    paint.flakes = gold;
    const Vec3 wi = test::direction_deg(25, 0), wo = test::direction_deg(40, 170);
    const double as_substrate = WeidlichWilkie::conductor(stack_of({slab(1.5, 0.1)}, gold), wi, wo);
    EXPECT_NEAR(WeidlichWilkie::specular(stack_of({paint}), wi, wo), 0.3 * as_substrate, 1e-12);
    EXPECT_NEAR(WeidlichWilkie::way_in(stack_of({paint}), wi, wo),
                0.7 * WeidlichWilkie::way_in(stack_of({slab(1.5, 0.1)}), wi, wo), 1e-14);
    paint.flakes = smoothed(gold);
    EXPECT_NEAR(WeidlichWilkie::specular_delta(stack_of({paint}), 0.8),
                fresnel(0.8, 1.5) + 0.3 * WeidlichWilkie::conductor_delta(
                                              stack_of({slab(1.5, 0.1)}, smoothed(gold)), 0.8),
                1e-12);
}

TEST(WeidlichWilkieParts, MatchedSlabScattersOnceAsHanrahanAndKrueger) {
    const double g = 0.6, tau = 0.4, own = 0.3;
    const Vec3 wi = test::direction_deg(35, 0), wo = test::direction_deg(60, 110);
    const double mu = -kernels::vec3_dot(wi, wo);
    const double phase = (1 - g * g) / (4 * M_PI * std::pow(1 + g * g - 2 * g * mu, 1.5));
    const double depth = tau + own;
    const double expected =
        own / depth * phase / (wi.z + wo.z) * (1 - std::exp(-depth * (1 / wi.z + 1 / wo.z)));
    EXPECT_NEAR(WeidlichWilkie::specular(stack_of({slab(1.0, tau, own, g)}), wi, wo), expected,
                1e-14);
    EXPECT_NEAR(WeidlichWilkie::way_in(stack_of({slab(1.0, tau, own, g)}), wi, wo),
                std::exp(-depth / wi.z), 1e-14);
    // thin: every photon that meets a particle leaves, half of it upwards for g = 0
    const double thin = 1e-5;
    const StackElements film = stack_of({slab(1.0, 0.0, thin)});
    const double up =
        albedo([&](const Vec3& i, const Vec3& o) { return WeidlichWilkie::specular(film, i, o); },
               test::direction_deg(20, 0));
    EXPECT_NEAR(up / (0.5 * thin / cos_deg(20)), 1.0, 2e-3); // midpoint rule
}

TEST(WeidlichWilkieParts, OrenNayarActsAtTheRefractedDirections) {
    const double sigma = 0.5, n = 1.5;
    const Vec3 wi = test::direction_deg(50, 0), wo = test::direction_deg(70, 30);
    const double si = std::sin(50 * M_PI / 180) / n, so = std::sin(70 * M_PI / 180) / n;
    const double a = 1 - 0.5 * 0.25 / (0.25 + 0.33), b = 0.45 * 0.25 / (0.25 + 0.09);
    const double expected = a + b * cos_deg(30) * so * si / std::sqrt(1 - si * si);
    EXPECT_NEAR(WeidlichWilkie::diffuse_shape(stack_of({slab(n)}), sigma, wi, wo), expected, 1e-12);
    EXPECT_EQ(WeidlichWilkie::diffuse_shape(stack_of({slab(n)}), 0.0, wi, wo), 1.0);
}

TEST(WeidlichWilkieParts, Case29IsReciprocal) {
    LayerValues paint = rough(1.5, 0.3, Distribution::Blinn, Scattering::Multiple);
    paint.tau = 0.2;
    paint.tau_scattering = 0.3;
    paint.anisotropy = 0.4;
    paint.flake_coverage = 0.2;
    paint.flakes = gold;
    const StackValues layers{paint, rough(1.3, 0.4)};
    const StackElements stack = stack_of(layers);
    const WeidlichWilkieResidual residual(stack_of(layers, perfect));
    const Vec3 wi = test::direction_deg(65, 0), wo = test::direction_deg(15, 80);
    const auto both = [&](const auto& f) { EXPECT_NEAR(f(wi, wo) / f(wo, wi), 1.0, 1e-12); };
    both([&](const Vec3& i, const Vec3& o) { return WeidlichWilkie::specular(stack, i, o); });
    both([&](const Vec3& i, const Vec3& o) {
        return WeidlichWilkie::conductor(stack_of(layers, gold), i, o);
    });
    both([&](const Vec3& i, const Vec3& o) { return residual.value(i.z, o.z); });
}

TEST(WeidlichWilkieParts, MultipleScatteringOfARoughInterfaceFollowsItsOperator) {
    for (const Distribution d : {Distribution::Ggx, Distribution::Beckmann, Distribution::Blinn}) {
        for (const double ior : {1.5, 1.0 / 1.5}) {
            const StackElements stack = stack_of({rough(ior, 0.8, d)});
            const auto operator_of = adding_transport(stack);
            const WeidlichWilkieResidual residual(stack);
            for (const double theta : {0.0, 45.0, 70.0}) {
                const Vec3 wi = test::direction_deg(theta, 0);
                const double lobe =
                    albedo([&](const Vec3& i,
                               const Vec3& o) { return WeidlichWilkie::specular(stack, i, o); },
                           wi);
                const double whole = operator_of->specular_albedo(wi.z);
                // from inside the critical angle's edge in the lobe costs the midpoint rule
                // 4e-4; from outside the two agree to 2e-5
                EXPECT_NEAR(lobe + residual(wi.z), whole, ior > 1.0 ? 5e-5 : 6e-4)
                    << kernel_distribution(d) << " " << ior << " " << theta;
                EXPECT_GT(residual(wi.z), 2e-3); // there is something to add
            }
        }
    }
}

TEST(WeidlichWilkieParts, PerfectRoughConductorReflectsEverything) {
    for (const Distribution d : {Distribution::Ggx, Distribution::Beckmann, Distribution::Blinn}) {
        SurfaceValues mirror = perfect;
        mirror.distribution = d;
        const StackElements stack = stack_of({}, mirror);
        const WeidlichWilkieResidual residual(stack);
        for (const double theta : {0.0, 45.0, 75.0}) {
            const Vec3 wi = test::direction_deg(theta, 0);
            const double lobe =
                albedo([&](const Vec3& i,
                           const Vec3& o) { return WeidlichWilkie::conductor(stack, i, o); },
                       wi);
            // lobe_albedo is good to 1e-3
            EXPECT_NEAR(lobe + residual(wi.z), 1.0, 2e-3) << kernel_distribution(d) << theta;
            EXPECT_EQ(residual.conductor_part(wi.z), residual(wi.z));
        }
    }
}

TEST(WeidlichWilkieParts, RoughMetalReflectsWhatTheWalkBetweenItsFacetsSays) {
    for (const Distribution d : {Distribution::Ggx, Distribution::Beckmann}) {
        const SurfaceValues metal = conductor_values(0.3, 3.0, d, 0.6);
        const StackElements stack = stack_of({}, metal);
        const WeidlichWilkieResidual residual(stack);
        SubstrateValues substrate;
        substrate.conductor = {metal};
        const LayerWalk walk({}, substrate, {550.0});
        for (const double theta : {0.0, 60.0}) {
            const Vec3 wi = test::direction_deg(theta, 0);
            const double lobe =
                albedo([&](const Vec3& i,
                           const Vec3& o) { return WeidlichWilkie::conductor(stack, i, o); },
                       wi);
            const WalkEstimate truth = estimate_walk(walk, wi, {}, 16384, 5);
            // one mean reflectance for all angles at facets costs 2e-3 here; 5.5 standard errors
            // are Sidak's bound for 4 comparisons
            EXPECT_NEAR(lobe + residual(wi.z), truth.mean.hemispherical.diffuse(0, 0),
                        3e-3 + 5.5 * truth.standard_error.hemispherical.diffuse(0, 0))
                << kernel_distribution(d) << " " << theta;
            EXPECT_GT(residual(wi.z), 0.05);
        }
    }
}

TEST(WeidlichWilkieParts, SingleScatteringHasNoResidual) {
    const WeidlichWilkieResidual residual(
        stack_of({rough(1.5, 0.4, Distribution::Ggx, Scattering::Single)}, gold));
    EXPECT_EQ(residual.average(), 0.0);
    EXPECT_EQ(residual.value(0.5, 0.7), 0.0);
}

TEST(WeidlichWilkieParts, ResidualBelowALayerIsDimmedByIt) {
    const WeidlichWilkieResidual bare(stack_of({}, perfect)),
        under(stack_of({slab(1.0, 0.5)}, perfect));
    // index matched: V = exp(-tau / c) and e between its largest value and none
    EXPECT_LT(under(1.0), bare(1.0) * std::exp(-1.0) * 1.0001);
    EXPECT_GT(under(1.0), 0.0);
    LayerValues sheet = slab(1.0);
    sheet.flake_coverage = 0.5;
    sheet.flakes = smoothed(gold);
    EXPECT_NEAR(WeidlichWilkieResidual(stack_of({sheet}, perfect))(0.7), 0.25 * bare(0.7), 1e-12);
}

TEST(WeidlichWilkieResidual, IsNowhereNegativeBetweenItsNodes) {
    for (const double alpha : {0.02, 0.05, 0.2}) {
        const WeidlichWilkieResidual residual(
            stack_of({{1.5, Distribution::Blinn, alpha, Scattering::Multiple, 0.0}}));
        for (int k = 0; k <= 4000; ++k)
            EXPECT_GE(residual(k / 4000.0), 0.0) << alpha << ", cosine " << k / 4000.0;
    }
}
