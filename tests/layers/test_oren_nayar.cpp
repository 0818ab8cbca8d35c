// An Oren-Nayar substrate beneath layers: adding against the walk, which knows no separable form.
#include "host/layers/models/adding.h"
#include "host/layers/models/layered_bsdf.h"
#include "host/layers/models/oren_nayar_substrate.h"
#include "kernels/scatter/oren_nayar.h"
#include "tests/layers/walk_stacks.h"
#include "tests/support/private_cache.h"

#include <gtest/gtest.h>

using namespace reradiant;

namespace {

const test::PrivateCache cache("oren-nayar");
const WavelengthGrid one{550, 10, 1};

SubstrateValues grey(double reflectance, double sigma) {
    return {.matrix = Eigen::MatrixXd::Constant(1, 1, reflectance), .sigma = sigma};
}

struct Case {
    const char* name;
    LayerStack stack;
};
std::vector<Case> cases() {
    return {{"smooth", {{plain_layer(1.5, 0.0, 0.1)}}},
            {"two smooth", {{plain_layer(1.3, 0.0, 0.0), plain_layer(1.7, 0.0, 0.1)}}},
            {"rough", {{plain_layer(1.5, 0.3, 0.0)}}},
            {"rough over smooth", {{plain_layer(1.3, 0.4, 0.2), plain_layer(1.6, 0.0, 0.0)}}},
            {"cloudy", {{cloudy_layer(1.5, 0.2, 0.05, 0.5, 0.6)}}}};
}

TEST(OrenNayarBeneath, EnergyIsThatOfTheWalk) {
    for (const auto& [name, stack] : cases())
        for (const double sigma : {0.2, 0.5}) {
            const SubstrateValues substrate = grey(0.9, sigma);
            const LayeredBsdf adding(stack, substrate, one, adding_bsdf);
            const LayerWalk walk(stack, substrate, {550.0});
            for (const double theta : {10.0, 45.0, 75.0}) {
                const kernels::Vec3 wi = test::direction_deg(theta, 0);
                const WalkEstimate found = estimate_walk(walk, wi, {}, 1 << 17, 3);
                const double truth = found.mean.hemispherical.diffuse(0);
                // half a per cent for the smaller eigenvalues; it was 1.6 % off without the largest
                EXPECT_NEAR(adding.diffuse_albedo(wi.z)(0), truth,
                            0.006 * truth + 4.0 * found.standard_error.hemispherical.diffuse(0))
                    << name << ", sigma " << sigma << ", " << theta << " degrees";
            }
        }
}

TEST(OrenNayarBeneath, DirectionsAreThoseOfTheWalk) {
    std::vector<kernels::Vec3> wo;
    for (const double theta : {20.0, 60.0, 80.0})
        for (const double phi : {0.0, 60.0, 120.0, 180.0})
            wo.push_back(test::direction_deg(theta, phi));
    for (const auto& [name, stack] : cases()) {
        const SubstrateValues substrate = grey(0.5, 0.34);
        const LayeredBsdf adding(stack, substrate, one, adding_bsdf);
        const LayerWalk walk(stack, substrate, {550.0});
        const kernels::Vec3 wi = test::direction_deg(60, 0);
        const WalkEstimate found = estimate_walk(walk, wi, wo, 1 << 16, 5);
        for (std::size_t k = 0; k < wo.size(); ++k) {
            const double truth = found.mean.directional[k].diffuse(0);
            // refracted alone, rough ones were up to 8 % off
            EXPECT_NEAR(adding.diffuse(wi, wo[k])(0), truth,
                        0.008 * truth + 4.0 * found.standard_error.directional[k].diffuse(0))
                << name << ", direction " << k;
        }
    }
}

TEST(OrenNayarBeneath, IsReciprocal) {
    const kernels::Vec3 a = test::direction_deg(70, 0), b = test::direction_deg(30, 50);
    for (const auto& [name, stack] : cases()) {
        const LayeredBsdf adding(stack, grey(0.8, 0.4), one, adding_bsdf);
        EXPECT_NEAR(adding.diffuse(a, b)(0) / adding.diffuse(b, a)(0), 1.0, 1e-9) << name;
    }
}

/// With all of a diffuse flux returned as it was sent, the kernel is the substrate's own, as far as
/// sums over 33 cosines are integrals.
TEST(SeparableOrenNayar, ADiffuseReturnKeepsTheDirectionalAlbedo) {
    const CosineNodes nodes(33);
    Eigen::VectorXd share(nodes.size());
    for (Eigen::Index k = 0; k < nodes.size(); ++k)
        share(k) = 2.0 * nodes.cosine(k) / static_cast<double>(nodes.size() - 1);
    share(nodes.size() - 1) *= 0.5;
    share /= share.sum();
    const double sigma = 0.5;
    const Eigen::MatrixXd returned = 0.6 * share * share.transpose();
    const SeparableOrenNayar found = separable_oren_nayar(sigma, nodes, returned);
    EXPECT_NEAR(separable_internal_reflectance(sigma, found, returned), 0.6, 1e-3);
    for (const double c : {0.1, 0.5, 0.9}) {
        double albedo = 0.0;
        for (Eigen::Index k = 0; k < nodes.size(); ++k)
            albedo += found.arriving(k) * oren_nayar_mean_value(sigma, c, nodes.cosine(k));
        EXPECT_NEAR(albedo, kernels::oren_nayar_albedo(sigma, c), 1e-3);
    }
}

TEST(SeparableOrenNayar, WhereNothingComesBackTheAlbedoIsTheSubstrates) {
    const CosineNodes nodes(33);
    const SeparableOrenNayar found =
        separable_oren_nayar(0.4, nodes, Eigen::MatrixXd::Zero(nodes.size(), nodes.size()));
    double albedo = 0.0;
    for (Eigen::Index k = 0; k < nodes.size(); ++k)
        albedo += found.arriving(k) * oren_nayar_mean_value(0.4, 0.7, nodes.cosine(k));
    EXPECT_NEAR(albedo, kernels::oren_nayar_albedo(0.4, 0.7), 1e-3);
}

} // namespace
