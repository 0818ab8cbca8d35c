// Balance of energy and photons of dyed stacks and sheets under adding, through what a
// goniophotometer asks of them, and reciprocity between the sides of sheets.
#include "tests/layers/dyed_balance.h"
#include "tests/support/full_run.h"
#include "tests/support/private_cache.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

using namespace reradiant;
using namespace reradiant::test;

namespace {

const PrivateCache cache("dyed_balance");

struct Dyed {
    LayerStack stack;
    Eigen::MatrixXd substrate;  ///< of sheets without meaning
    bool loses_nothing = false; ///< no photon
};

class RandomDyed {
public:
    explicit RandomDyed(unsigned seed) : random_(seed) {}

    /// One to three dyed slabs over a substrate or in air. If `spread` says so, some are rough at
    /// the top and some scatter.
    Dyed stack(bool spread) {
        Dyed made;
        made.loses_nothing = one_in(2);
        const int layers = std::uniform_int_distribution<int>(1, 3)(random_);
        for (int k = 0; k < layers; ++k)
            made.stack.layers.push_back(layer(spread, made.loses_nothing));
        made.substrate = (made.loses_nothing ? 1.0 : 0.7) * keeping_photons(shares());
        Layer& top = made.stack.layers.front();
        top.alpha = one_in(2) && spread && top.ior(500.0) > 1.0 ? 0.2 : 0.0;
        if (one_in(2))
            made.stack.lower_face = LowerFace{};
        return made;
    }

private:
    double number(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random_);
    }
    bool one_in(int n) { return std::uniform_int_distribution<int>(1, n)(random_) == 1; }

    Eigen::MatrixXd shares() {
        Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(3, 3);
        for (int i = 0; i < 3; ++i)
            for (int o = i; o < 3; ++o)
                lower(o, i) = number(0.0, 1.0);
        return lower;
    }

    Layer layer(bool spread, bool loses_nothing) {
        const std::array<double, 4> iors{1.0, 1.33, 1.5, 1.7};
        Layer made;
        made.ior =
            Spectrum::constant(iors[std::uniform_int_distribution<std::size_t>(0, 3)(random_)]);
        std::vector<double> depths, inert;
        for (int band = 0; band < 3; ++band) {
            depths.push_back(std::pow(10.0, number(-6.0, 1.0)));
            inert.push_back(loses_nothing || one_in(2) ? 0.0 : std::pow(10.0, number(-4.0, 0.0)));
        }
        made.absorption = at_three_bands(inert);
        const double yield = loses_nothing ? 1.0 : number(0.5, 1.0);
        made.dyes = {dye_of_three(depths, yield * keeping_photons(shares()))};
        if (one_in(2) && spread)
            made.scattering_coefficient = Spectrum::constant(number(0.1, 5.0));
        made.anisotropy = number(-0.5, 0.8);
        return made;
    }

    std::mt19937 random_;
};

/// Absorption depth of every source by band, (sources, bands); 1 of a substrate.
Eigen::MatrixXd absorbing(const LayerStack& stack, const StackCells& cells, Eigen::Index sources) {
    Eigen::MatrixXd depths = Eigen::MatrixXd::Ones(sources, 3);
    Eigen::Index source = 0;
    for (std::size_t slab = 0; slab < cells.size(); ++slab)
        for (int cell = 0; cell < cells[slab].count(); ++cell, ++source)
            for (int band = 0; band < 3; ++band) {
                const Layer& layer = stack.layers[slab];
                const double nm = three_bands.centre_nm(band);
                depths(source, band) = layer.thickness * cells[slab].share(cell) *
                                       (layer.absorption(nm) + layer.dyes[0].absorption(nm));
            }
    return depths;
}

/// What is absorbed and not sent out again of light of each band, by the band of absorption, from
/// what reaches the sources and what they send out at one size of cells.
Eigen::MatrixXd absorbed(const ReEmission& series, const Eigen::MatrixXd& depths,
                         const AirDirection& from) {
    Eigen::MatrixXd lost(3, 3);
    for (Eigen::Index i = 0; i < 3; ++i) {
        const Eigen::VectorXd first = series.at(i).reached(from.cosine, from.side);
        const Eigen::MatrixXd sent = series.sent(i, first);
        for (Eigen::Index band = 0; band < 3; ++band) {
            Eigen::VectorXd reached = series.at(band).exchange() * sent.col(band);
            if (band == i)
                reached += first;
            lost(band, i) = depths.col(band).dot(reached) - sent.col(band).sum();
        }
    }
    return lost;
}

/// The same of both sizes of cells, extrapolated as what leaves is.
Eigen::MatrixXd absorbed(const LayeredBsdf& bsdf, const LayerStack& stack,
                         const AirDirection& from) {
    const EmittingStack& emitting = *bsdf.emitting();
    StackCells fine = emitting.fine_cells(), coarse = fine;
    for (DepthCells& cells : coarse)
        cells.cells_per_octave /= 2;
    const auto of_level = [&](const ReEmission& series, const StackCells& cells) {
        return absorbed(series, absorbing(stack, cells, series.at(0).sources()), from);
    };
    return (4.0 * of_level(emitting.fine(), fine) - of_level(emitting.coarse(), coarse)) / 3.0;
}

/// In every band what comes and what is sent out leaves, is guided or is absorbed; without losses
/// as many photons leave as came. Where light is spread, what adding sends back and lets through,
/// and what reaches the dyes, are fitted to cells of direction apart.
void expect_balance(const LayeredBsdf& bsdf, const Dyed& dyed, double theta_deg) {
    const bool spread = !dyed.stack.is_smooth() || dyed.stack.scatters();
    const bool grazing = std::fabs(theta_deg - 90.0) < 1.0;
    const double tolerance = !spread ? 1e-6 : grazing ? 1e-3 : 1e-4;
    const double of_dyes = spread ? 5e-5 : 1e-6;
    const AirDirection from = air_deg(theta_deg);
    const Eigen::MatrixXd shares = not_absorbed(bsdf, from);
    EXPECT_LE(shares.colwise().sum().maxCoeff(), 1.0 + tolerance) << theta_deg;
    Eigen::MatrixXd off =
        shares + absorbed(bsdf, dyed.stack, from) - Eigen::MatrixXd::Identity(3, 3);
    EXPECT_LT(off.cwiseAbs().maxCoeff(), tolerance) << theta_deg << "\n" << off;
    off.diagonal().setZero();
    EXPECT_LT(off.cwiseAbs().maxCoeff(), of_dyes) << theta_deg << "\n" << off;
    const Eigen::RowVectorXd photons = in_photons(shares).colwise().sum();
    EXPECT_LE(photons.maxCoeff(), 1.0 + tolerance) << theta_deg;
    if (dyed.loses_nothing) {
        EXPECT_GE(photons.minCoeff(), 1.0 - tolerance) << theta_deg;
    }
}

} // namespace

TEST(DyedBalance, FiftyRandomStacksLoseNothing) {
    RandomDyed random(11);
    for (int trial = 0; trial < 50; ++trial) {
        SCOPED_TRACE(trial);
        const bool spread = trial % (test::is_full_run() ? 2 : 25) == 0;
        const Dyed dyed = random.stack(spread);
        const LayeredBsdf bsdf = adding_of(dyed.stack, dyed.substrate);
        for (const double theta : {0.0, 60.0, 89.9})
            expect_balance(bsdf, dyed, theta);
        if (dyed.stack.is_sheet())
            expect_balance(bsdf, dyed, 135.0);
    }
}

namespace {

/// Sheets of two dyed slabs: smooth; cloudy; rough on both sides; and with dispersion. They lose
/// light by yield and by what does not fluoresce.
std::vector<LayerStack> various_sheets() {
    const std::vector<double> shares{.1, 0, 0, .4, .2, 0, .2, .5, .3};
    Layer clear = dyed_layer(1.5, {1, .4, .1}, shares);
    clear.absorption = Spectrum::constant(0.1);
    Layer cloud = clear, rough = clear, dispersive = clear;
    cloud.scattering_coefficient = Spectrum::constant(2.0);
    cloud.anisotropy = 0.5;
    rough.alpha = 0.2;
    dispersive.ior = at_three_bands({1.7, 1.6, 1.5});
    const Layer other = dyed_layer(1.3, {.3, .2, 0}, shares);
    return {{{clear, other}, LowerFace{}},
            {{cloud, other}, LowerFace{}},
            {{rough, cloud}, LowerFace{.alpha = 0.2}},
            {{dispersive}, LowerFace{}}};
}

} // namespace

TEST(DyedBalance, Case65LightGoesTheSameWayBackThroughASheet) {
    for (const LayerStack& sheet : various_sheets()) {
        const LayeredBsdf bsdf = adding_of(sheet);
        for (const double from : {0.0, 45.0, 89.9, 135.0})
            for (const double to : {0.0, 60.0, 120.0, 180.0}) {
                const kernels::Vec3 a = direction_deg(from), b = direction_deg(to, 50);
                const Eigen::VectorXd there = bsdf.eval(a, b).diagonal();
                const Eigen::VectorXd back = bsdf.eval(b, a).diagonal();
                EXPECT_LT((there - back).norm(), 1e-10 * there.norm()) << from << " to " << to;
                EXPECT_GT(there.minCoeff(), 0.0);
            }
    }
}

TEST(DyedBalance, Case65SheetsFromBothSides) {
    for (const LayerStack& sheet : various_sheets()) {
        const LayeredBsdf bsdf = adding_of(sheet);
        const Dyed dyed{sheet, {}};
        for (const double theta : {0.0, 45.0, 89.9, 90.1, 135.0, 180.0})
            expect_balance(bsdf, dyed, theta);
    }
}

TEST(DyedBalance, Case65WhiteSheetsSendAllLightToOneOfTheirSides) {
    Layer cloud;
    cloud.scattering_coefficient = Spectrum::constant(3.0);
    cloud.anisotropy = 0.6;
    Layer rough = cloud, deep = cloud;
    rough.alpha = 0.2;
    deep.scattering_coefficient = Spectrum::constant(300.0);
    for (const Layer& layer : {cloud, rough, deep}) {
        const LayeredBsdf bsdf = adding_of({{layer}, LowerFace{}});
        for (const double theta : {0.0, 45.0, 89.9, 90.1, 180.0}) {
            const Eigen::MatrixXd shares = not_absorbed(bsdf, air_deg(theta));
            EXPECT_LT((shares.diagonal().array() - 1.0).abs().maxCoeff(), 1e-6) << theta;
        }
    }
}
