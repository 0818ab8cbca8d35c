#include "host/fit/result/fit_summary.h"
#include "tests/fit/fit_cases.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <filesystem>

using namespace reradiant;

// The number of terms is left to the evidence: what is there is found, and what is not said.

namespace {

const std::filesystem::path data_folder =
    std::filesystem::path(RERADIANT_SOURCE_DIR) / "tests" / "fit" / "data";

/// One to three dyes, 0.1 to 5 % noise of the peak, nothing told of it.
BispectralData ordinary_set(unsigned seed, bool is_fine) {
    std::mt19937 random(seed);
    const auto dyes = static_cast<int>(1 + random() % 3);
    const std::vector<double> steps =
        is_fine ? std::vector<double>{5.0, 10.0, 20.0} : std::vector<double>{10.0, 20.0};
    const double step = steps[random() % steps.size()];
    const auto grid = [&](double from, double to) {
        return WavelengthGrid{from, step, static_cast<int>((to - from) / step) + 1};
    };
    const WavelengthGrid emission = grid(random() % 2 == 0 ? 300.0 : 380.0, 780.0);
    const WavelengthGrid excitation = grid(300.0, random() % 2 == 0 ? 700.0 : 780.0);
    const ReradiationMatrix truth =
        white_matrix(random_fluorophores(random, dyes), emission, excitation);
    const double noise = 0.001 * std::pow(50.0, uniform(random, 0.0, 1.0));
    return noisy_data(truth, noise * stokes_peak(truth), false, seed);
}

/// Emission of one dye at a few excitations, as seen through a narrow bandpass.
BispectralData few_columns(const WavelengthGrid& excitation, double noise_of_peak, unsigned seed) {
    ReradiationMatrix truth;
    truth.emission = emission_10_nm();
    truth.excitation = excitation;
    truth.values.setZero(truth.emission.count, excitation.count);
    for (int i = 0; i < excitation.count; ++i)
        for (int o = 0; o < truth.emission.count; ++o)
            truth.values(o, i) =
                0.05 * std::exp(-0.5 * std::pow((excitation.centre_nm(i) - 380.0) / 35.0, 2) -
                                0.5 * std::pow((truth.emission.centre_nm(o) - 520.0) / 25.0, 2));
    return noisy_data(truth, noise_of_peak * stokes_peak(truth), false, seed);
}

} // namespace

TEST(OrdinarySets, ResidualsAreNoise) {
    const unsigned sets = test::is_full_run() ? 200 : 8;
    for (unsigned seed = 1; seed <= sets; ++seed) {
        const FitResult fit = fit_reradiation(ordinary_set(seed, test::is_full_run()), {});
        EXPECT_EQ(fit.failure, "") << seed;
        EXPECT_EQ(fit.shortfall, "") << seed;
        EXPECT_GE(fit.rank, 1) << seed;
        EXPECT_LE(fit.reduced_chi_squared, 2.0) << seed;
    }
}

TEST(OrdinarySets, ThreeDyesOnTwentyNanometres) {
    const FitResult fit = fit_reradiation(read_bispectral_data(data_folder / "three-dyes.csv"), {});
    EXPECT_EQ(fit.failure, "");
    EXPECT_EQ(fit.shortfall, "");
    EXPECT_EQ(fit.rank, 3);
    EXPECT_LE(fit.reduced_chi_squared, 1.3);
}

TEST(OrdinarySets, TwoExcitationsAreEnough) {
    for (const double apart : {5.0, 20.0, 50.0})
        for (const double noise : {0.005, 0.05}) {
            const BispectralData data = few_columns({360.0, apart, 2}, noise, 5);
            const FitResult fit = fit_reradiation(data, {});
            EXPECT_EQ(fit.failure, "") << apart << ' ' << noise;
            EXPECT_EQ(fit.shortfall, "") << apart << ' ' << noise;
            EXPECT_EQ(fit.rank, 1) << apart << ' ' << noise;
            // The errors of the data and of the fit, in units of the noise at the peak.
            EXPECT_LE(fit.rmse, 1.3 * noise * 0.05) << apart << ' ' << noise;
        }
}

TEST(OrdinarySets, OneExcitationWithoutNoiseIsAnEmissionSpectrum) {
    const FitResult fit = fit_reradiation(few_columns({365.0, 10.0, 1}, 0.0, 5), {});
    EXPECT_EQ(fit.failure, "");
    EXPECT_EQ(fit.shortfall, "");
    EXPECT_EQ(fit.rank, 1);
    EXPECT_LE(fit.relative_rmse, 0.01);
}

TEST(OrdinarySets, WhatNoModelFollowsIsSaid) {
    // A line that lies 60 nm beyond every excitation, as Raman scattering does, has as many terms
    // as there are excitations.
    ReradiationMatrix truth = true_matrix({});
    for (int i = 0; i < truth.excitation.count; ++i)
        for (int o = 0; o < truth.emission.count; ++o) {
            const double beyond =
                truth.emission.centre_nm(o) - truth.excitation.centre_nm(i) - 60.0;
            if (beyond > -50.0)
                truth.values(o, i) = 0.05 * std::exp(-0.5 * std::pow(beyond / 12.0, 2));
        }
    const BispectralData data = noisy_data(truth, 0.0005, true, 3);
    const FitResult fit = fit_reradiation(data, {});
    EXPECT_EQ(fit.failure, "");
    EXPECT_NE(fit.shortfall.find("times the noise"), std::string::npos) << fit.shortfall;
    EXPECT_GT(fit.reduced_chi_squared, 2.0);
    EXPECT_EQ(fit.rank, largest_factor_rank); // as much as there can be
    EXPECT_EQ(fit_summary(fit)["within_noise"], false);
    FitSettings every_entry;
    every_entry.model = FitModel::Matrix;
    EXPECT_EQ(fit_reradiation(data, every_entry).shortfall, "");
}
