#include "host/layers/angular/scattering_slab.h"
#include "reradiant/error.h"
#include "tests/layers/layer_values.h"
#include "tests/layers/reference_walk.h"
#include "tests/support/private_cache.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace reradiant;

namespace {

const test::PrivateCache cache("scattering-slab");

double cos_deg(double degrees) {
    return std::cos(degrees * M_PI / 180.0);
}
LayerValues slab(double ior, double alpha, double tau, double tau_scattering, double g) {
    LayerValues layer{ior, Distribution::Ggx, alpha, Scattering::Multiple, tau};
    layer.tau_scattering = tau_scattering;
    layer.anisotropy = g;
    return layer;
}

/// Chandrasekhar's H for isotropic scattering of albedo w, by iterating
/// 1 / H(m) = sqrt(1 - w) + w / 2 integral x H(x) / (m + x) dx on a midpoint grid in sqrt(x).
class ChandrasekharH {
public:
    explicit ChandrasekharH(double w) : albedo_(w), values_(count, 1.0) {
        for (int step = 0; step < 200; ++step) {
            std::vector<double> next;
            for (int i = 0; i < count; ++i)
                next.push_back((*this)(node(i)));
            values_ = next;
        }
    }
    double operator()(double m) const {
        double sum = 0.0;
        for (int i = 0; i < count; ++i) {
            const double x = node(i);
            sum += 2.0 * (i + 0.5) / (count * count) * x * values_[static_cast<std::size_t>(i)] /
                   (m + x);
        }
        return 1.0 / (std::sqrt(1.0 - albedo_) + 0.5 * albedo_ * sum);
    }

private:
    static constexpr int count = 400;
    static double node(int i) { return std::pow((i + 0.5) / count, 2.0); }
    double albedo_;
    std::vector<double> values_;
};

} // namespace

TEST(ScatteringSlab, Case21ThirtyDoublingsOfTwoFluxes) {
    // one cell is a model of two fluxes; isotropic scattering makes a thin layer reflect r = tau,
    // so tau / 2 of that case is half the depth: T = 1 / (1 + 1073.7 / 2)
    const AngularGrid grid{1.0, 0.0, {0.0, 1.0}};
    const double depth = std::ldexp(1e-6, 30) / 2;
    const SlabOperator op = scattering_slab(grid, 0.0, depth, 0.0);
    EXPECT_NEAR(op.through(0, 0), 0.001859, 5e-7);
    EXPECT_NEAR(op.through(0, 0) * (1.0 + depth), 1.0, 1e-6);
    EXPECT_NEAR(op.through(0, 0) + op.back(0, 0), 1.0, 1e-12);
}

TEST(ScatteringSlab, Case12And21ConservesFluxAndIsReciprocal) {
    const AngularGrid grid = make_angular_grid(1.5, std::sqrt(1.25) / 1.5, 64);
    const Eigen::VectorXd e = grid.etendue();
    for (const double g : {-0.5, 0.0, 0.9, 0.99, 0.9999}) {
        for (const double depth : {1e-8, 0.01, 1.0, 1073.7}) {
            const SlabOperator op = scattering_slab(grid, 0.0, depth, g);
            const Eigen::VectorXd sums = (op.back + op.through).colwise().sum().transpose();
            EXPECT_LT((sums.array() - 1.0).abs().maxCoeff(), 1e-9) << g << " " << depth;
            EXPECT_GE(op.back.minCoeff(), 0.0);
            EXPECT_GE(op.through.minCoeff(), 0.0);
            const Eigen::MatrixXd exchange = op.back * e.asDiagonal();
            EXPECT_LT((exchange - exchange.transpose()).cwiseAbs().maxCoeff(), 1e-12);
        }
    }
}

TEST(ScatteringSlab, DeepSlabHasChandrasekharsAlbedo) {
    for (const double w : {0.5, 0.9, 0.99}) {
        const auto t = adding_transport({slab(1.0, 0.0, (1.0 - w) * 200.0, w * 200.0, 0.0)});
        const ChandrasekharH h(w);
        for (const double theta : {0.0, 45.0, 70.0}) {
            const double c = cos_deg(theta);
            // 64 cells of direction: second order in their width
            EXPECT_NEAR(t->specular_albedo(c), 1.0 - std::sqrt(1.0 - w) * h(c), 5e-4)
                << w << " " << theta;
        }
    }
}

TEST(ScatteringSlab, ThinSlabScattersOnce) {
    const double depth = 1e-5, c = 0.7;
    const auto t = adding_transport({slab(1.0, 0.0, 0.0, depth, 0.0)});
    // half of what is scattered goes up
    EXPECT_NEAR(t->specular_albedo(c) / (0.5 * depth / c), 1.0, 2e-3);
    EXPECT_NEAR(t->transmission(c), 1.0 - 0.5 * depth / c, 1e-8);
}

TEST(ScatteringSlab, LosslessStacksOverWhiteReflectEverything) {
    const std::vector<StackValues> stacks{
        {slab(1.5, 0.0, 0.0, 2.0, 0.5)},
        {slab(1.5, 0.3, 0.0, 2.0, 0.5)},
        {slab(1.3, 0.0, 0.0, 0.5, 0.0), slab(1.6, 0.2, 0.0, 3.0, 0.8)},
        {slab(1.5, 0.0, 0.0, 0.0, 0.0), slab(1.5, 0.0, 0.0, 100.0, 0.9)},
    };
    for (const StackValues& stack : stacks) {
        const auto t = adding_transport(stack);
        const double n = t->lowest_ior();
        double mean = 0.0; // 2 integral c T dc by the midpoint rule, c = sin^2 u
        const int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double u = 0.5 * M_PI * (i + 0.5) / steps, c = std::sin(u) * std::sin(u);
            mean += 2.0 * c * t->transmission(c) * std::sin(2.0 * u) * 0.5 * M_PI / steps;
        }
        for (const double theta : {0.0, 60.0, 89.0}) {
            const double c = cos_deg(theta);
            const double albedo =
                t->specular_albedo(c) +
                t->transmission(c) * mean / (n * n * (1 - t->internal_reflectance()));
            EXPECT_NEAR(albedo, 1.0, 1e-7) << theta; // the midpoint rule here; kinks of T
        }
    }
}

TEST(ScatteringSlab, AgreesWithASlowWalk) {
    const std::vector<StackValues> stacks{
        {slab(1.5, 0.0, 0.1, 1.0, 0.0)},
        {slab(1.5, 0.0, 0.0, 3.0, 0.8)},
        {slab(1.5, 0.3, 0.2, 1.0, 0.5)},
        {slab(1.3, 0.0, 0.0, 0.5, -0.4), slab(1.6, 0.2, 0.1, 1.0, 0.9)},
        {slab(1.6, 0.1, 0.1, 0.0, 0.0), slab(1.3, 0.0, 0.1, 2.0, 0.3)},
    };
    const int photons = 40000;
    for (std::size_t k = 0; k < stacks.size(); ++k) {
        const auto t = adding_transport(stacks[k]);
        // 5.5 standard errors (35 comparisons at 1e-6) and 0.2 % for the cells
        const auto margin = [&](double p) {
            return 5.5 * std::sqrt(p * (1.0 - p) / photons) + 2e-3;
        };
        reference::Walker walker(31 + static_cast<unsigned>(k));
        for (const double theta : {1.0, 45.0, 80.0}) {
            double substrate = 0.0, air = 0.0;
            for (int i = 0; i < photons; ++i) {
                const auto end = walker.from_air(stacks[k], cos_deg(theta)).end;
                substrate += end == reference::Walker::End::Substrate;
                air += end == reference::Walker::End::Air;
            }
            const double p = substrate / photons, q = air / photons;
            EXPECT_NEAR(t->transmission(cos_deg(theta)), p, margin(p)) << k << " " << theta;
            EXPECT_NEAR(t->specular_albedo(cos_deg(theta)), q, margin(q)) << k << " " << theta;
        }
        double back = 0.0;
        for (int i = 0; i < photons; ++i)
            back += walker.from_substrate(stacks[k]).end == reference::Walker::End::Substrate;
        EXPECT_NEAR(t->internal_reflectance(), back / photons, margin(back / photons)) << k;
    }
}

TEST(ScatteringSlab, UnscatteredMirrorLightIsADelta) {
    const auto t = adding_transport({slab(1.5, 0.0, 0.1, 0.4, 0.0), slab(2.0, 0.0, 0.0, 0.0, 0.0)});
    const auto clear =
        adding_transport({slab(1.5, 0.0, 0.5, 0.0, 0.0), slab(2.0, 0.0, 0.0, 0.0, 0.0)});
    EXPECT_NEAR(t->specular_delta(0.8), clear->specular_delta(0.8), 1e-15);
    EXPECT_GT(t->residual(0.8), 0.01);
    EXPECT_TRUE(t->deeper_lobes().empty());
}

TEST(ScatteringSlab, WhatCannotBeIsRefused) {
    EXPECT_THROW(adding_transport({slab(1.5, 0.0, 0.0, -1.0, 0.0)}), Error);
    EXPECT_THROW(adding_transport({slab(1.5, 0.0, 0.0, 1.0, 1.0)}), Error);
    LayerValues filmed = slab(1.5, 0.2, 0.0, 0.0, 0.0);
    filmed.film = {300.0, 1.4};
    filmed.wavelength_nm = 550.0;
    EXPECT_THROW(adding_transport({filmed}), Error);
    LayerValues flakes = slab(1.5, 0.0, 0.0, 0.0, 0.0);
    flakes.flake_coverage = 0.5;
    EXPECT_THROW(adding_transport({flakes}), Error);
}
