#include "host/spectral/matrix/kubelka_munk.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <random>
#include <stdexcept>

using namespace reradiant;

namespace {

constexpr double OPAQUE = PigmentLayer::OPAQUE;
const WavelengthGrid GRID = grid_from_range(400.0, 700.0, 10.0);

/// Absorbs in one cell of GRID and emits in another, among a grey pigment.
PigmentLayer one_shift(double k, double s, double thickness) {
    PigmentLayer layer;
    layer.pigments = {{Spectrum::constant(k), Spectrum::constant(s), 1.0}};
    layer.dyes = {{Spectrum::line(450.0, 10.0, 20.0), Spectrum::line(600.0, 10.0, 1.0), 0.8, 1.5}};
    layer.thickness = thickness;
    return layer;
}

/// Bands of absorption and emission that overlap, so that light is re-absorbed.
PigmentLayer overlapping(double thickness, const Spectrum& backing) {
    PigmentLayer layer;
    layer.pigments = {
        {Spectrum::table({300, 800}, {0.5, 0.05}), Spectrum::table({300, 800}, {3, 2}), 1.0}};
    layer.dyes = {{Spectrum::gaussian(480, 40, 2.0), Spectrum::gaussian(530, 25, 1.0), 0.9, 1.0},
                  {Spectrum::gaussian(560, 30, 1.0), Spectrum::gaussian(610, 20, 1.0), 0.7, 0.5}};
    layer.thickness = thickness;
    layer.backing = backing;
    return layer;
}

/// Returns the matrix of a layer by the fluxes' own differential equations: the state (I, J) is
/// carried through the layer by Runge and Kutta, and the boundary conditions are solved for.
Eigen::MatrixXd by_integration(const PigmentLayer& layer, int steps) {
    const int n = GRID.count;
    Eigen::MatrixXd emission = Eigen::MatrixXd::Zero(n, n), loss(n, n), gain(n, n);
    Eigen::VectorXd k(n), s(n), backing(n);
    for (const Dye& dye : layer.dyes) // absorption within 0..1 is asked for
        emission += 10.0 * dye.concentration *
                    matrix_from_fluorophores(
                        {{dye.absorption.scaled(0.1), dye.emission, dye.quantum_yield}}, Spectrum(),
                        GRID, GRID)
                        .values;
    const auto mean = [](const Spectrum& spectrum, int band) {
        return spectrum.average(GRID.lower_edge_nm(band), GRID.upper_edge_nm(band));
    };
    for (int b = 0; b < n; ++b) {
        k(b) = s(b) = 0.0;
        for (const Pigment& pigment : layer.pigments) {
            k(b) += pigment.concentration * mean(pigment.absorption, b);
            s(b) += pigment.concentration * mean(pigment.scattering, b);
        }
        for (const Dye& dye : layer.dyes)
            k(b) += dye.concentration * mean(dye.absorption, b);
        backing(b) = mean(layer.backing, b);
    }
    loss = 0.5 * emission;
    loss.diagonal() -= k + s;
    gain = 0.5 * emission;
    gain.diagonal() += s;
    Eigen::MatrixXd derivative(2 * n, 2 * n);
    derivative << loss, gain, -gain, -loss;
    Eigen::MatrixXd carried = Eigen::MatrixXd::Identity(2 * n, 2 * n);
    const double h = layer.thickness / steps;
    for (int step = 0; step < steps; ++step) {
        const Eigen::MatrixXd a = derivative * carried, b = derivative * (carried + 0.5 * h * a),
                              c = derivative * (carried + 0.5 * h * b),
                              d = derivative * (carried + h * c);
        carried += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    // J(X) = backing I(X), with (I, J)(X) = carried (1, R).
    const auto block = [&](int row, int column) {
        return carried.block(row * n, column * n, n, n);
    };
    const Eigen::MatrixXd reflected = backing.asDiagonal();
    return (block(1, 1) - reflected * block(0, 1))
        .lu()
        .solve(reflected * block(0, 0) - block(1, 0));
}

} // namespace

TEST(KubelkaMunk, OpaqueLayersFollowTheClosedForm) {
    for (const double ratio : {1e-8, 0.01, 0.5, 1.0, 20.0, 1e6}) {
        const double known = 1.0 / (1.0 + ratio + std::sqrt(ratio * ratio + 2.0 * ratio));
        // The other root's inverse: no cancellation. 1e-15 is rounding.
        EXPECT_NEAR(kubelka_munk_reflectance(3.0 * ratio, 3.0, OPAQUE, 0.3), known, 1e-15);
    }
    EXPECT_EQ(kubelka_munk_reflectance(0.0, 2.0, OPAQUE, 0.0), 1.0);
    EXPECT_EQ(kubelka_munk_reflectance(2.0, 0.0, OPAQUE, 0.5), 0.0);
    EXPECT_THROW(kubelka_munk_reflectance(0.0, 0.0, OPAQUE, 0.5), std::invalid_argument);
}

TEST(KubelkaMunk, FiniteLayersFollowKubelka1948) {
    for (const double k : {0.02, 0.7, 5.0})
        for (const double thickness : {0.05, 0.6, 4.0})
            for (const double backing : {0.0, 0.4, 1.0}) {
                const double s = 1.3, a = 1.0 + k / s, b = std::sqrt(a * a - 1.0);
                const double coth = 1.0 / std::tanh(b * s * thickness);
                const double known = (1.0 - backing * (a - b * coth)) / (a - backing + b * coth);
                EXPECT_NEAR(kubelka_munk_reflectance(k, s, thickness, backing), known, 1e-14);
            }
}

TEST(KubelkaMunk, LimitsOfAFiniteLayer) {
    EXPECT_DOUBLE_EQ(kubelka_munk_reflectance(2.0, 3.0, 0.0, 0.37), 0.37);
    EXPECT_DOUBLE_EQ(kubelka_munk_reflectance(0.0, 0.0, 5.0, 0.37), 0.37);
    // No scattering: Beer-Lambert there and back. No absorption: (1 - R) / (1 - R_g) is known.
    EXPECT_NEAR(kubelka_munk_reflectance(0.8, 0.0, 0.5, 0.6), 0.6 * std::exp(-0.8), 1e-15);
    EXPECT_NEAR(kubelka_munk_reflectance(0.0, 2.0, 3.0, 0.25), 1.0 - 0.75 / (1.0 + 0.75 * 6.0),
                1e-15);
    EXPECT_NEAR(kubelka_munk_reflectance(0.0, 2.0, 3.0, 1.0), 1.0, 1e-15);
    EXPECT_DOUBLE_EQ(kubelka_munk_reflectance(0.8, 1.0, 1e9, 0.9),
                     kubelka_munk_reflectance(0.8, 1.0, OPAQUE, 0.0));
}

TEST(KubelkaMunk, MixturesAddUpByConcentration) {
    PigmentLayer layer;
    layer.pigments = {{Spectrum::constant(0.1), Spectrum::constant(5.0), 2.0},
                      {Spectrum::table({400, 700}, {3.0, 0.0}), Spectrum::constant(1.0), 0.25}};
    layer.dyes = {{Spectrum::constant(0.5), Spectrum::gaussian(600, 20, 1), 0.0, 0.4}};
    EXPECT_NEAR(layer.absorption(400.0), 0.2 + 0.75 + 0.2, 1e-15);
    EXPECT_NEAR(layer.scattering(550.0), 10.25, 1e-15);
    EXPECT_FALSE(layer.is_fluorescent());
    const Spectrum reflectance = kubelka_munk_spectrum(layer);
    EXPECT_NEAR(reflectance(550.0),
                kubelka_munk_reflectance(layer.absorption(550.0), 10.25, OPAQUE, 0.0), 1e-15);
    EXPECT_FALSE(reflectance.is_constant());
    layer.pigments.pop_back();
    EXPECT_TRUE(kubelka_munk_spectrum(layer).is_constant());
}

TEST(KubelkaMunk, WithoutADyeTheMatrixIsTheReflectance) {
    for (const double thickness : {OPAQUE, 0.3, 40.0}) {
        PigmentLayer layer = overlapping(thickness, Spectrum::constant(0.5));
        for (Dye& dye : layer.dyes)
            dye.concentration = 0.0;
        const ReradiationMatrix matrix = kubelka_munk_matrix(layer, GRID);
        EXPECT_FALSE(matrix.is_fluorescent());
        for (int band = 0; band < GRID.count; ++band) {
            // Coefficients that are linear over a cell: their means are the values at its centre.
            const double nm = GRID.centre_nm(band);
            const double known = kubelka_munk_reflectance(layer.absorption(nm),
                                                          layer.scattering(nm), thickness, 0.5);
            EXPECT_NEAR(matrix.values(band, band), known, 1e-12);
        }
    }
}

TEST(KubelkaMunk, OneShiftInAnOpaqueLayerFollowsItsIntegral) {
    // Absorbed at depth z in proportion to (1 + R_i) exp(-g_i z); half the light goes each way and
    // leaves by the share (1 + R_o) exp(-g_o z) / 2: their integral over z, g = sqrt(K (K + 2S)).
    const double k = 0.3, s = 2.0, ki = k + 1.5 * 2.0; // the line is 2 high
    const auto rate = [&](double absorption) {
        return std::sqrt(absorption * (absorption + 2 * s));
    };
    const double ri = kubelka_munk_reflectance(ki, s, OPAQUE, 0.0);
    const double ro = kubelka_munk_reflectance(k, s, OPAQUE, 0.0);
    const double f = 0.8 * 3.0 * 450.0 / 600.0;
    const double known = 0.5 * f * (1.0 + ri) * (1.0 + ro) / (rate(ki) + rate(k));
    const ReradiationMatrix matrix = kubelka_munk_matrix(one_shift(k, s, OPAQUE), GRID);
    // The mean of 1 / (energy of the photons) over a 10 nm cell differs from that of its centre by
    // 2e-5 of it.
    EXPECT_NEAR(matrix.values(GRID.band_of(600.0), GRID.band_of(450.0)), known, 5e-5 * known);
    EXPECT_NEAR(matrix.values(GRID.band_of(450.0), GRID.band_of(450.0)), ri, 1e-12);
    EXPECT_EQ(matrix.values(GRID.band_of(450.0), GRID.band_of(600.0)), 0.0);
}

TEST(KubelkaMunk, PhotonsThatAPureDyeAbsorbsAllComeBack) {
    PigmentLayer layer = one_shift(0.0, 2.0, OPAQUE);
    layer.dyes[0].quantum_yield = 1.0;
    for (const double concentration : {1e-3, 1.5, 1e6}) {
        layer.dyes[0].concentration = concentration;
        const ColumnBalance balance = column_balance(kubelka_munk_matrix(layer, GRID));
        // Photons are counted at the cells' centres: 2e-5 as above.
        for (const double photons : balance.photons)
            EXPECT_NEAR(photons, 1.0, 5e-5);
    }
}

TEST(KubelkaMunk, MatricesAgreeWithTheFluxesOwnEquations) {
    for (const double thickness : {0.02, 0.4, 1.5})
        for (const double backing : {0.0, 0.7, 1.0}) {
            const PigmentLayer layer = overlapping(thickness, Spectrum::constant(backing));
            const Eigen::MatrixXd known = by_integration(layer, 400);
            // Runge-Kutta: (rate * step)^4 with a rate of 10, and what shooting amplifies: exp(9).
            EXPECT_LT((kubelka_munk_matrix(layer, GRID).values - known).cwiseAbs().maxCoeff(),
                      1e-8);
        }
}

TEST(KubelkaMunk, ThickLayersBecomeOpaqueOnes) {
    const Eigen::MatrixXd opaque =
        kubelka_munk_matrix(overlapping(OPAQUE, Spectrum()), GRID).values;
    for (const double thickness : {60.0, 1e4, 1e9})
        for (const double backing : {0.0, 1.0}) {
            const PigmentLayer layer = overlapping(thickness, Spectrum::constant(backing));
            // Doubling loses some digits over tens of doublings; 60 is a depth of over 20.
            EXPECT_LT((kubelka_munk_matrix(layer, GRID).values - opaque).cwiseAbs().maxCoeff(),
                      1e-11);
        }
}

TEST(KubelkaMunk, NoLayerGainsEnergyOrHasNegativeEntries) {
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int trial = 0; trial < 60; ++trial) {
        const auto amount = [&] { return std::pow(10.0, 6.0 * uniform(generator) - 3.0); };
        PigmentLayer layer = overlapping(uniform(generator) < 0.5 ? OPAQUE : amount(),
                                         Spectrum::constant(uniform(generator)));
        layer.pigments[0].concentration = amount();
        for (Dye& dye : layer.dyes) {
            dye.concentration = amount();
            dye.quantum_yield = 1.0;
        }
        const ReradiationMatrix matrix = kubelka_munk_matrix(layer, GRID);
        EXPECT_GE(matrix.values.minCoeff(), -1e-12);
        const ColumnBalance balance = column_balance(matrix);
        for (int i = 0; i < GRID.count; ++i) {
            EXPECT_LE(balance.radiant[static_cast<std::size_t>(i)], 1.0 + 1e-9);
            // Light of a 10 nm cell is counted as photons of its centre: 1e-3 within one cell.
            EXPECT_LE(balance.photons[static_cast<std::size_t>(i)], 1.0 + 1e-2);
        }
    }
}

TEST(KubelkaMunk, AnOpaqueLayerOfNothingIsRefused) {
    PigmentLayer layer = one_shift(0.0, 0.0, OPAQUE);
    EXPECT_THROW(kubelka_munk_matrix(layer, GRID), std::invalid_argument);
    EXPECT_THROW(kubelka_munk_spectrum(layer), std::invalid_argument);
    layer.thickness = 1.0;
    EXPECT_NO_THROW(kubelka_munk_matrix(layer, GRID));
}
