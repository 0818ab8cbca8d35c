#include "kernels/scatter/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace reradiant::kernels;

namespace {

/// Textbook amplitudes in extended precision.
long double reflectance_by_amplitudes(long double cos_i, long double eta) {
    const long double sin2_t = (1.0L - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1.0L)
        return 1.0L;
    const long double cos_t = std::sqrt(1.0L - sin2_t);
    const long double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const long double p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return 0.5L * (s * s + p * p);
}

} // namespace

TEST(Fresnel, AgreesWithTheAmplitudesOverAllAnglesAndIndices) {
    for (const double eta : {0.25, 0.5, 1 / 1.5, 0.9, 1.0001, 1.3, 1.5, 2.4, 4.0}) {
        for (double theta = 0.0; theta < 90.0; theta += 0.37) {
            const double c = std::cos(theta * M_PI / 180.0);
            const auto expected = static_cast<double>(reflectance_by_amplitudes(c, eta));
            // near the critical angle the root magnifies rounding of c by its inverse square root
            EXPECT_NEAR(fresnel_dielectric(c, eta), expected, 1e-7 * expected + 1e-16)
                << eta << " at " << theta;
        }
    }
}

TEST(Fresnel, Case13IndexOneReflectsNothing) {
    for (const double c : {0.0, 1e-8, 0.5, 1.0}) {
        EXPECT_EQ(fresnel_dielectric(c, 1.0), 0.0);
        EXPECT_EQ(fresnel_cos_transmitted(c, 1.0), c);
    }
}

TEST(Fresnel, Case14IndexNearOneKeepsItsPrecision) {
    // R(0) = ((eta - 1) / (eta + 1))^2, which the difference form must give to rounding
    for (const double d : {1e-4, 1e-6}) {
        const double exact = d * d / ((2.0 + d) * (2.0 + d));
        EXPECT_NEAR(fresnel_dielectric(1.0, 1.0 + d) / exact, 1.0, 1e-9);
    }
}

TEST(Fresnel, Case15TotalReflectionIsExactAndItsEdgeIsSmooth) {
    const double eta = 1.0 / 1.5, critical = std::sqrt(1.0 - eta * eta);
    EXPECT_EQ(fresnel_dielectric(critical - 1e-9, eta), 1.0);
    EXPECT_EQ(fresnel_cos_transmitted(critical - 1e-9, eta), 0.0);
    EXPECT_EQ(fresnel_dielectric(0.0, eta), 1.0);
    const double edge = fresnel_dielectric(critical + 1e-7, eta);
    EXPECT_NEAR(edge, 0.9965, 1e-3);
    EXPECT_LT(edge, 1.0);
}

TEST(Fresnel, IsReciprocalAcrossTheInterface) {
    for (double c = 0.01; c <= 1.0; c += 0.01) {
        const double inside = fresnel_cos_transmitted(c, 1.7);
        EXPECT_NEAR(fresnel_dielectric(c, 1.7), fresnel_dielectric(inside, 1.0 / 1.7), 1e-12);
    }
}
