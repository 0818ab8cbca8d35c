#include "host/layers/models/weidlich_wilkie.h"
#include "tests/layers/layer_values.h"
#include "tests/support/directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace reradiant;
using kernels::Vec3;

namespace {

double fresnel(double c, double n) {
    const double t = std::sqrt(1.0 - (1.0 - c * c) / (n * n));
    const double s = (c - n * t) / (c + n * t), p = (n * c - t) / (n * c + t);
    return 0.5 * (s * s + p * p);
}

} // namespace

TEST(WeidlichWilkie, SmoothLayerIsTwoFresnelPassagesAndBeerLambert) {
    const StackElements stack =
        stack_of({{1.5, Distribution::Blinn, 0.0, Scattering::Single, 0.3}});
    const Vec3 wi = test::direction_deg(45, 0), wo = test::direction_deg(20, 130);
    const double ci = std::sqrt(1 - 0.5 / 2.25), s = std::sin(20 * M_PI / 180);
    const double co = std::sqrt(1 - s * s / 2.25);
    EXPECT_NEAR(WeidlichWilkie::way_in(stack, wi, wo),
                (1 - fresnel(wi.z, 1.5)) * std::exp(-0.3 / ci), 1e-14);
    EXPECT_NEAR(WeidlichWilkie::way_out(stack, wi, wo),
                (1 - fresnel(wo.z, 1.5)) * std::exp(-0.3 / co), 1e-14);
    EXPECT_EQ(WeidlichWilkie::specular(stack, wi, wo), 0.0);
    EXPECT_NEAR(WeidlichWilkie::specular_delta(stack, wi.z), fresnel(wi.z, 1.5), 1e-14);
}

TEST(WeidlichWilkie, RoughLayerFollowsTheSeedsShader) {
    // the shader of the tutorial: F D G / (4 nl nv), T12 at v.h, t = (1 - G) + (1 - F) G
    const double alpha = 0.4, exponent = blinn_exponent(alpha);
    const StackElements stack =
        stack_of({{1.5, Distribution::Blinn, alpha, Scattering::Single, 0.0}});
    const Vec3 wi = test::direction_deg(60, 0), wo = test::direction_deg(75, 150);
    const double hx = wi.x + wo.x, hy = wi.y + wo.y, hz = wi.z + wo.z;
    const double length = std::sqrt(hx * hx + hy * hy + hz * hz);
    const double ndoth = hz / length, vdoth = (wi.x * hx + wi.y * hy + wi.z * hz) / length;
    const double d = (exponent + 2) / (2 * M_PI) * std::pow(ndoth, exponent);
    const double g = std::min({1.0, 2 * ndoth * wo.z / vdoth, 2 * ndoth * wi.z / vdoth});
    ASSERT_LT(g, 1.0);
    const double f = fresnel(vdoth, 1.5);
    EXPECT_NEAR(WeidlichWilkie::specular(stack, wi, wo), f * d * g / (4 * wi.z * wo.z), 1e-12);
    EXPECT_NEAR(WeidlichWilkie::way_in(stack, wi, wo), 1 - f, 1e-12);
    EXPECT_NEAR(WeidlichWilkie::way_out(stack, wi, wo), (1 - g) + (1 - f) * g, 1e-12);
    EXPECT_EQ(WeidlichWilkie::specular_delta(stack, 0.5), 0.0);
}

TEST(WeidlichWilkie, LowerInterfacesAreSeenThroughTheUpperOnes) {
    const LayerValues top{1.5, Distribution::Blinn, 0.0, Scattering::Single, 0.2};
    const StackElements both = stack_of({top, {1.8, Distribution::Blinn, 0.0, Scattering::Single}});
    const double inner = fresnel(1.0, 1.8 / 1.5), outer = fresnel(1.0, 1.5);
    const double through = (1 - outer) * (1 - outer) * std::exp(-0.4);
    EXPECT_NEAR(WeidlichWilkie::specular_delta(both, 1.0), outer + through * inner, 1e-14);
}

TEST(WeidlichWilkie, TotalReflectionLetsNothingThrough) {
    const StackElements stack =
        stack_of({{0.5, Distribution::Blinn, 0.0, Scattering::Single, 0.1}});
    EXPECT_EQ(WeidlichWilkie::way_in(stack, test::direction_deg(60, 0), test::direction_deg(10, 0)),
              0.0);
    EXPECT_EQ(
        WeidlichWilkie::way_out(stack, test::direction_deg(10, 0), test::direction_deg(60, 0)),
        0.0);
    EXPECT_EQ(WeidlichWilkie::specular_delta(stack, std::cos(60 * M_PI / 180)), 1.0);
}
