#include "host/layers/smooth/smooth_stack.h"
#include "reradiant/error.h"
#include "tests/layers/layer_values.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace reradiant;

namespace {

LayerValues smooth(double ior, double tau = 0.0) {
    return {ior, Distribution::Ggx, 0.0, Scattering::Multiple, tau};
}
double cos_deg(double degrees) {
    return std::cos(degrees * M_PI / 180.0);
}

double fresnel(double c1, double n1, double c2, double n2) {
    const double s = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
    const double p = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
    return 0.5 * (s * s + p * p);
}

/// Composite Simpson in u with c = a + (b - a) sin^2 u, written apart from the library's rule.
template <typename Function>
double integrate(double a, double b, const Function& f) {
    const int steps = 2000;
    double sum = 0.0;
    for (int i = 0; i <= steps; ++i) {
        const double u = 0.5 * M_PI * i / steps;
        const double weight = i == 0 || i == steps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        sum += weight * f(a + (b - a) * std::sin(u) * std::sin(u)) * std::sin(2.0 * u);
    }
    return sum * (b - a) * 0.5 * M_PI / steps / 3.0;
}

/// 2 integral c T dc over the air side, split where media thinner than air reflect totally.
double mean_transmission(const StackModel& t, double split) {
    const auto f = [&](double c) { return 2.0 * c * t.transmission(c); };
    return split > 0.0 && split < 1.0 ? integrate(0.0, split, f) + integrate(split, 1.0, f)
                                      : integrate(0.0, 1.0, f);
}

} // namespace

TEST(SmoothTransport, InternalReflectanceOfIndexOnePointFive) {
    // published value of the diffuse internal reflectance of n = 1.5
    EXPECT_NEAR(adding_transport({smooth(1.5)})->internal_reflectance(), 0.596346, 5e-7);
}

TEST(SmoothTransport, Case13AndCase19NothingAboveTheSubstrateIsTheIdentity) {
    for (const StackValues& stack : {StackValues{}, StackValues{smooth(1.0)}}) {
        const auto t = adding_transport(stack);
        for (const double c : {0.0, 1e-8, 0.3, 1.0}) {
            EXPECT_EQ(t->transmission(c), 1.0);
            EXPECT_EQ(t->specular_albedo(c), 0.0);
        }
        EXPECT_NEAR(t->internal_reflectance(), 0.0, 1e-15);
    }
}

TEST(SmoothTransport, OneInterfaceIsFresnelAtEveryAngle) {
    for (const double n : {1.0 + 1e-6, 1.3, 1.5, 2.4, 4.0}) {
        const auto t = adding_transport({smooth(n)});
        for (const double theta : {0.0, 45.0, 80.0, 89.0, 89.999}) {
            const double c = cos_deg(theta), inside = std::sqrt(n * n - 1.0 + c * c) / n;
            // the textbook form in the test loses digits at grazing and near n = 1
            EXPECT_NEAR(t->specular_albedo(c), fresnel(c, 1.0, inside, n), 1e-9);
            EXPECT_NEAR(t->specular_albedo(c) + t->transmission(c), 1.0, 1e-14);
        }
    }
}

TEST(SmoothTransport, Case16LosslessSlab) {
    const auto t = adding_transport({smooth(1.5), smooth(1.0)});
    EXPECT_NEAR(t->specular_albedo(1.0), 1.0 / 13.0, 1e-14); // 2 r / (1 + r), r = 0.04
    EXPECT_NEAR(t->transmission(1.0), 12.0 / 13.0, 1e-14);
    EXPECT_NEAR(t->internal_reflectance() + mean_transmission(*t, 0.0), 1.0, 1e-9);
}

TEST(SmoothTransport, AbsorbingSlabEqualsItsSeries) {
    // light that crosses the slab 1, 3, 5 ... times between the interfaces 1.3 and 1.6
    for (const double tau : {1e-8, 0.1, 3.0}) {
        const auto t = adding_transport({smooth(1.3, tau), smooth(1.6)});
        for (const double theta : {0.0, 45.0, 80.0, 89.0}) {
            const double c0 = cos_deg(theta), s = std::sin(theta * M_PI / 180.0);
            const double c1 = std::sqrt(1.0 - s * s / 1.69), c2 = std::sqrt(1.0 - s * s / 2.56);
            const double top = fresnel(c0, 1.0, c1, 1.3), bottom = fresnel(c1, 1.3, c2, 1.6);
            const double a = std::exp(-tau / c1);
            double through = 0.0, back = top, flux = (1.0 - top) * a;
            for (int order = 0; order < 400; ++order) {
                through += flux * (1.0 - bottom);
                back += flux * bottom * a * (1.0 - top);
                flux *= bottom * a * top * a;
            }
            EXPECT_NEAR(t->transmission(c0) / through, 1.0, 1e-12);
            EXPECT_NEAR(t->specular_albedo(c0) / back, 1.0, 1e-12);
        }
    }
}

TEST(SmoothTransport, WhiteSubstrateUnderAnyLosslessStackReflectsEverything) {
    const std::vector<StackValues> stacks{
        {smooth(1.5)},
        {smooth(4.0)},
        {smooth(1.0 + 1e-6)},
        {smooth(1.3), smooth(1.6)},
        {smooth(1.6), smooth(1.3)},
        {smooth(1.7), smooth(1.0), smooth(1.4)}, // total reflection at a medium in the middle
        StackValues(64, smooth(1.5)),
    };
    for (const StackValues& stack : stacks) {
        const auto t = adding_transport(stack);
        const double n = t->lowest_ior(), r = t->internal_reflectance();
        const double split = std::sqrt(std::fabs(n * n - 1.0)) / n < 0.5 ? 2e-3 : 0.0;
        const double escape = mean_transmission(*t, split) / (n * n);
        // reciprocity: what goes in goes out. 1e-12 where the test's Simpson rule resolves it
        EXPECT_NEAR(escape + r, 1.0, 1e-11);
        for (const double theta : {0.0, 45.0, 80.0, 89.0, 89.999}) {
            const double c = cos_deg(theta);
            EXPECT_NEAR(t->specular_albedo(c) + t->transmission(c) * escape / (1.0 - r), 1.0,
                        1e-10);
            EXPECT_NEAR(t->specular_albedo(c) + t->transmission(c), 1.0, 1e-12);
        }
    }
}

TEST(SmoothTransport, SixtyFourAlternatingLayersConserveEnergy) {
    StackValues stack;
    for (int k = 0; k < 64; ++k)
        stack.push_back(smooth(k % 2 == 0 ? 1.6 : 1.3));
    const auto t = adding_transport(stack);
    for (const double theta : {0.0, 60.0, 89.999}) {
        EXPECT_NEAR(t->specular_albedo(cos_deg(theta)) + t->transmission(cos_deg(theta)), 1.0,
                    1e-12);
    }
    EXPECT_NEAR(mean_transmission(*t, 0.0) / (1.3 * 1.3) + t->internal_reflectance(), 1.0, 1e-10);
}

TEST(SmoothTransport, Case20DeepAbsorptionIsBlackAndFinite) {
    for (const double tau : {104.0, 1e4}) {
        const auto t = adding_transport({smooth(1.5, tau), smooth(1.3)});
        EXPECT_LT(t->transmission(1.0), 1e-40);
        EXPECT_EQ(t->transmission(0.0), 0.0);
        EXPECT_NEAR(t->specular_albedo(1.0), 0.04, 1e-15);
        EXPECT_GE(t->internal_reflectance(), 0.0);
        EXPECT_LE(t->internal_reflectance(), 1.0);
    }
}

TEST(SmoothTransport, Case18ThinAbsorptionKeepsItsPrecision) {
    for (const double tau : {1e-6, 1e-8}) {
        const auto t = adding_transport({smooth(1.0, tau)});
        // rounding of 1 - T over tau
        EXPECT_NEAR((1.0 - t->transmission(1.0)) / -std::expm1(-tau), 1.0, 1e-7);
        // r of a bare absorbing slab is 0: nothing comes back
        EXPECT_NEAR(t->internal_reflectance(), 0.0, 1e-12);
    }
}

TEST(SmoothTransport, Case22LosslessTrapIsUnreachableAndFinite) {
    // q beyond every outer medium: reflected on both sides of the middle one
    const SmoothStack stack{{1.0, 1.5, 1.0}, {0.0, 0.0, 0.0}};
    const SmoothResponse response = smooth_response_g2(stack, 1.0, -0.5);
    EXPECT_EQ(response.transmission, 0.0);
    EXPECT_TRUE(std::isfinite(response.loss_up));
    EXPECT_TRUE(std::isfinite(response.reflection_down));
}

TEST(SmoothTransport, ImpossibleValuesAreRefused) {
    EXPECT_THROW(adding_transport({smooth(0.0)}), Error);
    EXPECT_THROW(adding_transport({smooth(std::nan(""))}), Error);
    EXPECT_THROW(adding_transport({smooth(1.5, -1.0)}), Error);
    EXPECT_THROW(adding_transport({{1.5, Distribution::Ggx, 1.5, Scattering::Multiple, 0.0}}),
                 Error);
}
