// Stiff and extreme cases of dyes in slabs under adding: what leaves, what is guided and what is
// absorbed add up to what comes.
#include "reradiant/error.h"
#include "tests/layers/dyed_balance.h"
#include "tests/support/private_cache.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

using namespace reradiant;
using namespace reradiant::test;

namespace {

const PrivateCache cache("dyed_stack_cases");

const std::vector<double> angles_deg{0, 45, 75, 89, 89.9};

/// Within the bands 1 and 2, and from each to all that are longer.
const std::vector<double> up{0, 0, 0, .6, .3, 0, .2, .5, .9};

Layer photon_keeping(double ior, const std::vector<double>& depths,
                     const std::vector<double>& shares = up) {
    Layer layer = dyed_layer(ior, depths, shares);
    layer.dyes = {dye_of_three(depths, keeping_photons(matrix_of_three(shares)))};
    return layer;
}

/// All photons that come leave somewhere or are guided.
void expect_all_photons(const LayeredBsdf& bsdf, const std::string& what,
                        const std::vector<double>& angles = angles_deg) {
    for (const double theta : angles) {
        const Eigen::MatrixXd shares = not_absorbed(bsdf, air_deg(theta));
        EXPECT_TRUE(shares.allFinite()) << what;
        EXPECT_GE(shares.minCoeff(), -1e-12) << what << " at " << theta;
        const Eigen::RowVectorXd sums = in_photons(shares).colwise().sum();
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(sums(i), 1.0, 1e-6) << what << " at " << theta << ", band " << i;
    }
}

} // namespace

TEST(DyedStackCases, Case60ThinAndThickDyesKeepTheirLight) {
    const Eigen::MatrixXd white = Eigen::MatrixXd::Identity(3, 3);
    for (const double depth : {1e-8, 1.0, 1e3})
        for (const double ior : {1.0, 1.5}) {
            const Layer dyed = photon_keeping(ior, {depth, 0.3 * depth, 0.1 * depth});
            const std::string what =
                "depth " + std::to_string(depth) + ", n " + std::to_string(ior);
            expect_all_photons(adding_of({{dyed}, LowerFace{}}), "sheet of " + what);
            expect_all_photons(adding_of({{dyed}}, white), "over white, " + what);
        }
}

TEST(DyedStackCases, Case60AThinDyeKeepsItsDigits) {
    // every ray passes a clear sheet once in all, down or up, and half of what leaves is above
    const double n = 1.5, share = 0.8, depth = 1e-8;
    const LayeredBsdf bsdf =
        adding_of({{dyed_layer(n, {depth, 0, 0}, {0, 0, 0, share, 0, 0, 0, 0, 0})}, LowerFace{}});
    for (const double theta : angles_deg) {
        const AirDirection from = air_deg(theta);
        const double cosine = std::sqrt(n * n - 1.0 + from.cosine * from.cosine) / n;
        const double sent = share * depth / cosine;
        const double guided = std::sqrt(1.0 - 1.0 / (n * n));
        for (const Side side : {Side::Above, Side::Below})
            EXPECT_NEAR(bsdf.albedo(from, side).slab(1, 0) / sent, 0.5 * (1.0 - guided), 2e-5);
        EXPECT_NEAR(bsdf.guided(from)(1, 0) / sent, guided, 2e-5);
    }
}

TEST(DyedStackCases, Case60NoDyeAndNoThicknessAreBitEqualToNoDye) {
    Layer plain;
    plain.alpha = 0.2;
    plain.scattering = Scattering::Single;
    plain.absorption = at_three_bands({.1, .2, .3});
    plain.scattering_coefficient = Spectrum::constant(1.0);
    Layer dyed = plain;
    dyed.dyes = {dye_of_three({1, .4, 0}, matrix_of_three(up))};
    Layer no_concentration = dyed, no_thickness = dyed, thin = plain;
    no_concentration.dyes[0].concentration = 0.0;
    no_thickness.thickness = thin.thickness = 0.0;
    const auto expect_equal = [](const LayeredBsdf& a, const LayeredBsdf& b) {
        EXPECT_EQ(a.emitting(), nullptr);
        EXPECT_EQ(a.coupling(), b.coupling());
        const kernels::Vec3 wi = direction_deg(30);
        EXPECT_EQ(a.eval(wi, direction_deg(50, 120)), b.eval(wi, direction_deg(50, 120)));
        EXPECT_EQ(a.eval(wi, direction_deg(130, 20)), b.eval(wi, direction_deg(130, 20)));
        EXPECT_EQ(not_absorbed(a, air_deg(30)), not_absorbed(b, air_deg(30)));
    };
    const Eigen::MatrixXd ground = 0.5 * Eigen::MatrixXd::Identity(3, 3);
    for (const std::optional<LowerFace>& face : {std::optional(LowerFace{}), {}}) {
        expect_equal(adding_of({{no_concentration}, face}, ground),
                     adding_of({{plain}, face}, ground));
        expect_equal(adding_of({{no_thickness}, face}, ground), adding_of({{thin}, face}, ground));
    }
}

TEST(DyedStackCases, Case61ALosslessSmoothSheetGuides) {
    const double share = std::sqrt(1.0 - 1.0 / (1.5 * 1.5));
    const LayeredBsdf clear =
        adding_of({{photon_keeping(1.5, {3, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 0, 0})}, LowerFace{}});
    expect_all_photons(clear, "clear where it sends out");
    for (const double theta : angles_deg) {
        const AirDirection from = air_deg(theta);
        const double guided = clear.guided(from)(1, 0);
        const double leaves =
            clear.albedo(from, Side::Above).slab(1, 0) + clear.albedo(from, Side::Below).slab(1, 0);
        EXPECT_NEAR(guided / (guided + leaves), share, 1e-4);
    }
    // hardly absorbed, but sent out again within the band until it leaves
    for (const double depth : {1e-3, 1e-6, 1e-9}) {
        const LayeredBsdf ends = adding_of(
            {{photon_keeping(1.5, {3, depth, 0}, {0, 0, 0, 1, 1, 0, 0, 0, 0})}, LowerFace{}});
        EXPECT_EQ(ends.guided(air_deg(0)).sum(), 0.0);
        expect_all_photons(ends, "hardly absorbed again");
    }
}

TEST(DyedStackCases, Case62EmissionWithinTheDyesOwnAbsorption) {
    const std::vector<double> within{1, 0, 0, 0, 1, 0, 0, 0, 1},
        cascade{0, 0, 0, 1, .5, 0, 0, .5, 1};
    const std::vector<double> some_angles{60, 89.9};
    const Eigen::MatrixXd white = Eigen::MatrixXd::Identity(3, 3);
    for (const std::vector<double>& shares : {within, cascade})
        for (const double depth : {1.0, 30.0, 1e3}) {
            const Layer dyed = photon_keeping(1.5, {depth, 2 * depth, 3 * depth}, shares);
            expect_all_photons(adding_of({{dyed}}, white), "over white", some_angles);
            if (depth < 100.0 || shares == within)
                expect_all_photons(adding_of({{dyed}, LowerFace{}}), "sheet", some_angles);
        }
}

// A dye that sends all light out in the band that it absorbs is a cloud that scatters alike to all
// sides and absorbs nothing: the two are added up by different means. Of deep ones hardly any light
// gets through, 1e-3 of it at a depth of 1e3.
TEST(DyedStackCases, Case62ADyeThatKeepsItsBandIsACloud) {
    const std::vector<double> within{1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (const double ior : {1.0, 1.5})
        for (const double depth : {9.0, 30.0, 1e3}) {
            const std::vector<double> depths{depth, 2 * depth, 3 * depth};
            Layer cloud;
            cloud.ior = Spectrum::constant(ior);
            cloud.scattering_coefficient = at_three_bands(depths);
            const LayeredBsdf dyed =
                adding_of({{photon_keeping(ior, depths, within)}, LowerFace{}});
            const LayeredBsdf scattering = adding_of({{cloud}, LowerFace{}});
            EXPECT_LE(dyed.emitting()->error(), EmittingStack::tolerance) << depth;
            for (const double theta : {0.0, 60.0})
                for (const Side side : {Side::Above, Side::Below}) {
                    const Eigen::MatrixXd off = all_light(dyed.albedo(air_deg(theta), side)) -
                                                all_light(scattering.albedo(air_deg(theta), side));
                    EXPECT_LT(off.cwiseAbs().maxCoeff(), 2e-4)
                        << "n " << ior << ", depth " << depth << ", " << theta << " degrees";
                }
            // over white, too, all comes back
            EXPECT_LE(
                adding_of({{photon_keeping(ior, depths, within)}}, Eigen::MatrixXd::Identity(3, 3))
                    .emitting()
                    ->error(),
                EmittingStack::tolerance)
                << depth;
        }
}

TEST(DyedStackCases, Case62HardlyAbsorbingClouds) {
    for (const double depth : {1.0, 30.0, 1e3}) {
        Layer cloud = photon_keeping(1.5, {1, .3, 0});
        cloud.scattering_coefficient = Spectrum::constant(depth);
        cloud.absorption = Spectrum::constant(1e-9 * depth);
        cloud.anisotropy = 0.5;
        const LayeredBsdf bsdf = adding_of({{cloud}}, Eigen::MatrixXd::Identity(3, 3));
        for (const double theta : {0.0, 45.0, 89.9}) {
            const Eigen::RowVectorXd sums =
                in_photons(not_absorbed(bsdf, air_deg(theta))).colwise().sum();
            // what comes back and what reaches the dyes are fitted to cells of direction apart
            EXPECT_LE(sums.maxCoeff(), 1.0 + 2e-5) << depth << " at " << theta;
            EXPECT_GE(sums.minCoeff(), 1.0 - 2e-5 - 1e-8 * depth) << depth << " at " << theta;
        }
    }
}

namespace {

/// The largest difference of what leaves at an angle, and of values in directions, relative to the
/// largest entry of each.
double largest_difference(const LayeredBsdf& a, const LayeredBsdf& b, double theta) {
    const auto relative = [](const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
        return (x - y).cwiseAbs().maxCoeff() / y.cwiseAbs().maxCoeff();
    };
    const AirDirection from = air_deg(theta);
    double largest = 0.0;
    for (const Side side : {Side::Above, Side::Below})
        largest = std::max(
            largest, relative(all_light(a.albedo(from, side)), all_light(b.albedo(from, side))));
    for (const double theta_o : {0.0, 60.0, 120.0, 180.0}) {
        const kernels::Vec3 wi = direction_deg(theta), wo = direction_deg(theta_o, 70);
        largest = std::max(largest, relative(a.eval(wi, wo), b.eval(wi, wo)));
    }
    return largest;
}

} // namespace

TEST(DyedStackCases, Case63NoInterfaceIsThereBetweenDyesOfOneMedium) {
    const std::vector<double> whole{1.5, .4, .1}, part{.9, .24, .06}, rest{.6, .16, .04};
    for (const double ior : {1.0, 1.5})
        for (const double cloud : {0.0, 3.0}) {
            const auto layer = [&](const std::vector<double>& depths, double share) {
                Layer made = photon_keeping(ior, depths);
                made.scattering_coefficient = Spectrum::constant(share * cloud);
                return made;
            };
            const LayeredBsdf two = adding_of({{layer(part, 0.6), layer(rest, 0.4)}, LowerFace{}});
            const LayeredBsdf one = adding_of({{layer(whole, 1.0)}, LowerFace{}});
            // of a cloud, one slab and two have cells of direction of their own
            const double bound = two.emitting()->error() + one.emitting()->error() + 1e-5 * cloud;
            for (const double theta : {0.0, 75.0, 89.0, 89.9})
                EXPECT_LE(largest_difference(two, one, theta), bound)
                    << "n " << ior << ", scattering " << cloud << ", at " << theta;
        }
}

namespace {

const std::vector<double> up_and_down{.2, .3, .1, .4, .2, .3, .2, .3, .3};

/// What every source sends out, (sources, bands), of light that reaches the sources in one band:
/// one dense system over all bands and sources.
Eigen::MatrixXd sent_densely(const ReEmission& series, const DepthCells& cells,
                             const Eigen::MatrixXd& slab, Eigen::Index excitation,
                             const Eigen::VectorXd& reached) {
    const Eigen::Index bands = series.bands(), n = reached.size();
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(bands * n, bands * n);
    Eigen::VectorXd first = Eigen::VectorXd::Zero(bands * n);
    for (Eigen::Index o = 0; o < bands; ++o)
        for (Eigen::Index cell = 0; cell < n; ++cell) {
            const double share = cells.share(static_cast<int>(cell));
            first(o * n + cell) = share * slab(o, excitation) * reached(cell);
            for (Eigen::Index i = 0; i < bands; ++i)
                system.block(o * n + cell, i * n, 1, n) -=
                    share * slab(o, i) * series.at(i).exchange().row(cell);
        }
    return system.partialPivLu().solve(first).reshaped(n, bands);
}

} // namespace

TEST(DyedStackCases, Case64AntiStokesSharesAreSolvedDensely) {
    for (const double depth : {0.5, 5.0, 100.0}) {
        const LayerStack stack{{photon_keeping(1.5, {depth, depth, depth}, up_and_down)},
                               LowerFace{}};
        const LayeredBsdf bsdf = adding_of(stack);
        expect_all_photons(bsdf, "anti-Stokes of depth " + std::to_string(depth), {60});
        const EmittingStack& emitting = *bsdf.emitting();
        EXPECT_FALSE(emitting.shifts_up());
        for (Eigen::Index i = 0; i < 3 && depth < 10.0; ++i) {
            const ReEmission& series = emitting.fine();
            const Eigen::VectorXd reached = series.at(i).reached(0.8, Side::Above);
            const Eigen::MatrixXd expected =
                sent_densely(series, emitting.fine_cells()[0],
                             slab_emissions(stack, three_bands)[0], i, reached);
            EXPECT_LT((series.sent(i, reached) - expected).norm(), 1e-9 * expected.norm()) << depth;
        }
    }
}

TEST(DyedStackCases, Case64ASeriesThatGrowsIsAnError) {
    // shares of more than all cannot be read from a file, but they can be given to the class
    const auto stack_of = [](const Eigen::Matrix3d& shares) {
        DyedStack stack;
        const SurfaceValues top{.ior_above = 1.0, .ior_below = 1.5}, bottom{1.5, 1.0};
        stack.by_band.assign(3,
                             {top, SlabValues{.ior = 1.5, .tau = 20.0, .tau_dyes = 20.0}, bottom});
        stack.slabs = {20.0 * shares};
        return stack;
    };
    const auto within = [](double share) { return share * Eigen::Matrix3d::Identity(); };
    Eigen::Matrix3d around = Eigen::Matrix3d::Zero();
    around(1, 0) = around(2, 1) = around(0, 2) = 1.0;
    EXPECT_NO_THROW(EmittingStack(stack_of(within(0.99))));
    EXPECT_NO_THROW(EmittingStack(stack_of(0.99 * around)));
    EXPECT_THROW(EmittingStack(stack_of(within(1.2))), Error);
    EXPECT_THROW(EmittingStack(stack_of(1.2 * around)), Error);
}

TEST(DyedStackCases, TwentyDyedSlabsKeepTheirPhotons) {
    LayerStack stack;
    for (int slab = 0; slab < 20; ++slab)
        stack.layers.push_back(
            photon_keeping(slab % 2 == 0 ? 1.4 : 1.6, {.1 * slab, .05 * slab, .01 * slab}));
    expect_all_photons(adding_of(stack, Eigen::MatrixXd::Identity(3, 3)), "over white");
    stack.lower_face = LowerFace{};
    expect_all_photons(adding_of(stack), "sheet");
}
