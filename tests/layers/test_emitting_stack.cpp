#include "host/layers/sources/emitting_stack.h"
#include "host/layers/sources/source_transport.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace reradiant {
namespace {

Eigen::Matrix3d matrix(const std::array<double, 9>& rows) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

/// One slab at three bands, over a Lambertian matrix or in air. Its dye sends out `shares`.
struct OneSlab {
    double ior = 1.5, alpha = 0.0;
    std::array<double, 3> inert{}, dye{};
    double scattering = 0.0, anisotropy = 0.0;
    Eigen::Matrix3d shares = Eigen::Matrix3d::Zero();
    std::optional<Eigen::Matrix3d> substrate = {}; ///< none: a sheet
};

DyedStack stack_of(const OneSlab& one) {
    DyedStack stack;
    for (std::size_t band = 0; band < 3; ++band) {
        const SurfaceValues top{.ior_above = 1.0,
                                .ior_below = one.ior,
                                .alpha = one.alpha,
                                .scattering = Scattering::Single};
        StackElements elements{top, SlabValues{.ior = one.ior,
                                               .tau = one.inert[band] + one.dye[band],
                                               .tau_scattering = one.scattering,
                                               .anisotropy = one.anisotropy,
                                               .may_scatter = one.scattering > 0.0,
                                               .tau_dyes = one.dye[band]}};
        SurfaceValues bottom = top;
        std::swap(bottom.ior_above, bottom.ior_below);
        if (one.substrate)
            elements.push_back(DiffuseValues{.ior_above = one.ior});
        else
            elements.push_back(bottom);
        stack.by_band.push_back(elements);
    }
    const Eigen::Vector3d depths(one.dye[0], one.dye[1], one.dye[2]);
    stack.slabs = {one.shares * depths.asDiagonal()};
    if (one.substrate)
        stack.substrate = *one.substrate;
    return stack;
}

double cosine_of(double degrees) {
    return std::cos(degrees * std::numbers::pi / 180.0);
}

/// The dye of most cases: band 0 excites both others, band 1 the last.
const Eigen::Matrix3d stokes = matrix({0, 0, 0, .5, 0, 0, .2, .7, 0});

struct Measured {
    int out, in;
    double reflected, reflected_error, transmitted, transmitted_error;
};
struct MeasuredSlab {
    std::string name;
    OneSlab slab;
    double theta_deg;
    std::vector<Measured> values;
};

/// Values of an independent random walk, which an integral equation confirmed, for light of shifted
/// bands: nothing else is sent out and not reflected or scattered.
std::vector<MeasuredSlab> measured_slabs() {
    const Eigen::Matrix3d black = Eigen::Matrix3d::Zero();
    return {{"index-matched sheet",
             {.ior = 1.0, .dye = {1.5, .4, 0}, .shares = stokes},
             30,
             {{1, 0, 0.1412212, 0.00017, 0.11, 0.00016},
              {2, 0, 0.1385048, 0.00017, 0.1381223, 0.00017},
              {2, 1, 0.1295177, 0.00017, 0.129585, 0.00017}}},
            {"smooth, over black",
             {.dye = {2, .5, 0}, .shares = stokes, .substrate = black},
             0,
             {{1, 0, 0.03948325, 9.7e-05, 0, 0},
              {2, 0, 0.0389885, 9.7e-05, 0, 0},
              {2, 1, 0.0302685, 8.6e-05, 0, 0}}},
            {"smooth, over a fluorescent substrate",
             {.inert = {.02, .01, .01},
              .dye = {.8, .2, 0},
              .shares = stokes,
              .substrate = matrix({.3, 0, 0, .3, .5, 0, .1, .3, .8})},
             45,
             {{1, 0, 0.105111, 0.00015, 0, 0},
              {2, 0, 0.2451548, 0.00022, 0, 0},
              {2, 1, 0.3433005, 0.00024, 0, 0}}},
            {"scattering forwards, over black",
             {.ior = 1.4,
              .inert = {.05, .05, .05},
              .dye = {1, .3, .1},
              .scattering = 5,
              .anisotropy = .5,
              .shares = matrix({.05, 0, 0, .45, .2, 0, .2, .5, .3}),
              .substrate = black},
             0,
             {{1, 0, 0.101232, 0.00015, 0, 0},
              {2, 0, 0.08667175, 0.00014, 0, 0},
              {2, 1, 0.08614075, 0.00014, 0, 0}}},
            {"index-matched scattering sheet",
             {.ior = 1.0, .dye = {1, .3, 0}, .scattering = 3, .shares = stokes},
             40,
             {{1, 0, 0.1599548, 0.00018, 0.06252675, 0.00012},
              {2, 0, 0.1386195, 0.00017, 0.08395625, 0.00014},
              {2, 1, 0.165133, 0.00019, 0.107917, 0.00016}}},
            {"rough scattering sheet",
             {.ior = 1.5,
              .alpha = .2,
              .inert = {.02, .02, .02},
              .dye = {1, .4, 0},
              .scattering = 2,
              .anisotropy = .3,
              .shares = stokes},
             30,
             {{1, 0, 0.07119965, 0.00018, 0.05215957, 0.00015},
              {2, 0, 0.1214631, 0.00022, 0.1116164, 0.00021},
              {2, 1, 0.1547815, 0.00024, 0.144291, 0.00024}}}};
}

TEST(EmittingStack, AgreesWithIndependentWalks) {
    for (const MeasuredSlab& measured : measured_slabs()) {
        SCOPED_TRACE(measured.name);
        const EmittingStack stack(stack_of(measured.slab));
        const AirDirection from{cosine_of(measured.theta_deg), Side::Above};
        const Eigen::MatrixXd above = stack.albedo(from, Side::Above, EmittingStack::Part::All);
        for (const Measured& value : measured.values) {
            EXPECT_NEAR(above(value.out, value.in), value.reflected,
                        std::max(4.0 * value.reflected_error, 0.002 * value.reflected));
        }
        if (measured.slab.substrate)
            continue;
        const Eigen::MatrixXd below = stack.albedo(from, Side::Below, EmittingStack::Part::All);
        for (const Measured& value : measured.values)
            EXPECT_NEAR(below(value.out, value.in), value.transmitted,
                        std::max(4.0 * value.transmitted_error, 0.002 * value.transmitted));
    }
}

TEST(EmittingStack, MatchesTheClosedFormOfASheetThatDoesNotReabsorb) {
    const double share = 0.6, cosine = cosine_of(40);
    for (const double depth : {1e-8, 1e-3, 0.1, 1.0, 10.0, 1e3}) {
        SCOPED_TRACE(depth);
        const EmittingStack stack(stack_of(
            {.ior = 1.0, .dye = {depth, 0, 0}, .shares = matrix({0, 0, 0, share, 0, 0, 0, 0, 0})}));
        const double expected = -std::expm1(-depth / cosine) * share / 2.0;
        for (const Side side : {Side::Above, Side::Below})
            EXPECT_NEAR(stack.albedo({cosine, Side::Above}, side, EmittingStack::Part::All)(1, 0),
                        expected, 1e-4 * expected);
    }
}

TEST(EmittingStack, CountsWhatASmoothSheetGuides) {
    const double share = 0.8;
    const EmittingStack stack(
        stack_of({.dye = {1000, 0, 0}, .shares = matrix({0, 0, 0, share, 0, 0, 0, 0, 0})}));
    const AirDirection from{1.0, Side::Above};
    const double guided = stack.guided(from)(1, 0);
    const double above = stack.albedo(from, Side::Above, EmittingStack::Part::All)(1, 0);
    const double below = stack.albedo(from, Side::Below, EmittingStack::Part::All)(1, 0);
    const double into_sheet = 1.0 - 0.04; // Fresnel at the normal; the lower face sees nothing
    EXPECT_NEAR(guided / (share * into_sheet), std::sqrt(1.0 - 1.0 / 2.25), 1e-4);
    EXPECT_NEAR(guided + above + below, share * into_sheet, 1e-4);
}

/// A stack of one to three dyed slabs at one band, some rough, some scattering, over a substrate
/// or in air.
StackElements random_stack(std::mt19937& random) {
    const auto number = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    const auto one_in = [&](int n) {
        return std::uniform_int_distribution<int>(1, n)(random) == 1;
    };
    const std::array<double, 4> iors{1.0, 1.33, 1.5, 1.7};
    StackElements stack;
    double ior = 1.0;
    for (int layer = std::uniform_int_distribution<int>(1, 3)(random); layer > 0; --layer) {
        const double below = iors[std::uniform_int_distribution<std::size_t>(0, 3)(random)];
        stack.push_back(SurfaceValues{
            .ior_above = ior, .ior_below = below, .alpha = one_in(4) && below != ior ? 0.2 : 0.0});
        ior = below;
        stack.push_back(SlabValues{.ior = ior,
                                   .tau = std::pow(10.0, number(-6.0, 1.5)),
                                   .tau_scattering = one_in(3) ? number(0.1, 5.0) : 0.0,
                                   .anisotropy = number(-0.5, 0.8)});
    }
    if (one_in(2))
        stack.push_back(DiffuseValues{.ior_above = ior});
    else
        stack.push_back(SurfaceValues{.ior_above = ior, .ior_below = 1.0});
    return stack;
}

TEST(SourceTransport, LosesNothingOfWhatIsSentOut) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 50; ++trial) {
        SCOPED_TRACE(trial);
        const StackElements stack = random_stack(random);
        StackCells cells;
        std::vector<double> absorbing; // depth of every source
        for (const StackElement& element : stack)
            if (const auto* slab = std::get_if<SlabValues>(&element)) {
                cells.push_back(depth_cells(slab->depth(), 2));
                for (int cell = 0; cell < cells.back().count(); ++cell)
                    absorbing.push_back(slab->tau * cells.back().share(cell));
            }
        const bool is_sheet = !std::holds_alternative<DiffuseValues>(stack.back());
        if (!is_sheet)
            absorbing.push_back(1.0);
        const auto transport = source_transport(stack, cells);
        const auto count = static_cast<Eigen::Index>(absorbing.size());
        ASSERT_EQ(transport->sources(), count);
        Eigen::VectorXd kept = transport->exchange().transpose() *
                                   Eigen::Map<const Eigen::VectorXd>(absorbing.data(), count) +
                               transport->escaped(Side::Above) + transport->guided();
        if (is_sheet)
            kept += transport->escaped(Side::Below);
        EXPECT_NEAR(kept.minCoeff(), 1.0, 1e-6);
        EXPECT_NEAR(kept.maxCoeff(), 1.0, 1e-6);
        const Eigen::MatrixXd both_ways = transport->exchange() * transport->weights().asDiagonal();
        EXPECT_LT((both_ways - both_ways.transpose()).norm(), 1e-9 * both_ways.norm());
    }
}

} // namespace
} // namespace reradiant
