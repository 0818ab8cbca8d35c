#include "reradiant/error.h"
#include "tests/fit/fit_cases.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace reradiant;

// Data that a fit either gets right or must say what it cannot tell about.

namespace {

FitResult fit(const BispectralData& data, std::optional<int> rank = {}) {
    FitSettings settings;
    settings.rank = rank;
    return fit_reradiation(data, settings);
}

} // namespace

TEST(Stiff, NearlyIdenticalFluorophoresAreNotTakenForTwo) {
    const ReradiationMatrix truth =
        true_matrix({{440.0, 30.0, 0.4, 560.0, 25.0, 0.8}, {440.5, 30.0, 0.4, 560.5, 25.0, 0.8}});
    const double noise = 0.01 * stokes_peak(truth);
    const BispectralData data = noisy_data(truth, noise, true, 11);
    const FitResult by_evidence = fit(data);
    EXPECT_EQ(by_evidence.failure, "");
    EXPECT_EQ(by_evidence.rank, 1);
    EXPECT_LE(stokes_rmse(by_evidence.matrix, truth), 0.5 * noise);
}

TEST(Stiff, AFluorophoreAThousandTimesWeakerIsFoundBelowSmallNoise) {
    const ReradiationMatrix truth = true_matrix(
        {{520.0, 35.0, 0.8, 620.0, 22.0, 0.9}, {360.0, 25.0, 0.0008, 450.0, 20.0, 0.9}});
    const double peak = stokes_peak(truth);
    const FitResult fine = fit(noisy_data(truth, 2e-5 * peak, true, 11), 2);
    EXPECT_EQ(fine.failure, "");
    const Eigen::Index o = 7, i = 6; // 450 nm, 360 nm
    EXPECT_NEAR(fine.matrix.values(o, i) / truth.values(o, i), 1.0, 0.1);
    const FitResult coarse = fit(noisy_data(truth, 1e-2 * peak, true, 11));
    EXPECT_EQ(coarse.rank, 1); // far below the noise: nothing is made up
}

TEST(Stiff, OneBandOfEmission) {
    ReradiationMatrix truth = true_matrix({two_fluorophores()[0]});
    const Eigen::VectorXd row = truth.values.row(22).transpose();
    for (int o = 0; o < truth.emission.count; ++o)
        for (int i = 0; i < truth.excitation.count; ++i)
            if (truth.emission.centre_nm(o) > truth.excitation.centre_nm(i) && o != 22)
                truth.values(o, i) = 0.0;
    const double noise = 0.005 * stokes_peak(truth);
    const FitResult result = fit(noisy_data(truth, noise, true, 2), 1);
    EXPECT_EQ(result.failure, "");
    EXPECT_LE(stokes_rmse(result.matrix, truth), noise);
    EXPECT_NEAR(result.matrix.values(22, 18), row(18), 5.0 * noise);
}

TEST(Stiff, EmptyMatrixIsNoFluorescence) {
    const ReradiationMatrix truth = true_matrix({});
    const FitResult zero = fit(noisy_data(truth, 0.0, false, 2));
    EXPECT_EQ(zero.failure, "");
    EXPECT_EQ(zero.rank, 0);
    EXPECT_EQ(zero.bytes, 0u);
    EXPECT_TRUE(zero.matrix.fluorescent_part().isZero(0.0));
    const FitResult noise = fit(noisy_data(truth, 0.01, true, 2));
    EXPECT_EQ(noise.failure, "");
    EXPECT_EQ(noise.rank, 0);
    EXPECT_TRUE(says(noise.notes, "no fluorescence"));
}

TEST(Stiff, MissingColumnAndBlockAreSaid) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    const double noise = 0.005 * stokes_peak(truth);
    BispectralData data = noisy_data(truth, noise, true, 2);
    data.blocks[0].value.col(20).setConstant(not_measured); // 500 nm
    data.blocks[0].value.block(24, 4, 6, 8).setConstant(not_measured);
    const FitResult result = fit(data, 2);
    EXPECT_EQ(result.failure, "");
    EXPECT_TRUE(says(result.notes, "500"));
    EXPECT_TRUE(result.matrix.values.allFinite());
    // The block is known from its rows and columns; the column is bridged from its neighbours.
    EXPECT_LE((result.matrix.values - truth.values).block(24, 4, 6, 8).cwiseAbs().maxCoeff(),
              5.0 * noise);
    EXPECT_NEAR(result.matrix.values(22, 20) / truth.values(22, 20), 1.0, 0.05);
}

TEST(Stiff, SaturatedBlockDoesNotBendTheRest) {
    const ReradiationMatrix truth = true_matrix({two_fluorophores()[0]});
    const double noise = 0.002 * stokes_peak(truth), limit = 0.8 * stokes_peak(truth);
    BispectralData data = noisy_data(truth, noise, true, 2);
    for (double& value : data.blocks[0].value.reshaped())
        value = std::min(value, limit);
    const FitResult result = fit(data, 1);
    EXPECT_EQ(result.failure, "");
    EXPECT_TRUE(says(result.notes, "saturated"));
    EXPECT_LE(stokes_rmse(result.matrix, truth), noise);
}

TEST(Stiff, Case48BadlyScaledDataGiveTheSameAnswer) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    const BispectralData data = noisy_data(truth, 0.01 * stokes_peak(truth), true, 2);
    BispectralData tiny = data;
    tiny.blocks[0].value *= 1e-9;
    tiny.blocks[0].sigma *= 1e-9;
    const FitResult usual = fit(data, 2), small = fit(tiny, 2);
    EXPECT_EQ(small.failure, "");
    EXPECT_NEAR(small.relative_rmse, usual.relative_rmse, 1e-6);
    EXPECT_EQ(small.trace.iterations, usual.trace.iterations);
}

TEST(Stiff, FewerDataThanNumbersAreRefused) {
    BispectralData data = noisy_data(true_matrix(two_fluorophores()), 0.01, true, 2);
    for (int i = 0; i < data.excitation.count; ++i)
        for (int o = 0; o < data.emission.count; ++o)
            if ((o + 3 * i) % 29 != 0)
                data.blocks[0].value(o, i) = not_measured;
    try {
        fit(data, 4);
        ADD_FAILURE() << "fitted more numbers than there are data";
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2);
        EXPECT_NE(std::string(error.what()).find("synthetic.csv"), std::string::npos);
    }
}

TEST(Stiff, YieldOfWhatHardlyAbsorbsIsUnknown) {
    const ReradiationMatrix truth = true_matrix({{440.0, 30.0, 0.02, 600.0, 25.0, 0.7}},
                                                emission_10_nm(), excitation_10_nm(), 0.97);
    BispectralData data = noisy_data(truth, 0.01 * stokes_peak(truth), true, 9);
    for (int i = 8; i < data.excitation.count; ++i)
        data.blocks[0].sigma(i - 8, i) = 0.2; // against an absorptance of 2 %
    const FitResult result = fit(data, 1);
    ASSERT_EQ(result.quantum_yield.size(), 1u);
    EXPECT_TRUE(std::isnan(result.quantum_yield[0].value));
    EXPECT_TRUE(says(result.warnings, "unknown"));
}

TEST(Stiff, Case51UncertainAbsorptanceIsWarnedAbout) {
    // A bright sample: 2 % absorbed, known to 1 % of the white.
    const ReradiationMatrix truth = true_matrix({{440.0, 30.0, 0.02, 600.0, 25.0, 0.7}},
                                                emission_10_nm(), excitation_10_nm(), 0.97);
    BispectralData data = noisy_data(truth, 0.01 * stokes_peak(truth), true, 9);
    for (int i = 8; i < data.excitation.count; ++i)
        data.blocks[0].sigma(i - 8, i) = 0.03;
    const FitResult result = fit(data, 1);
    EXPECT_EQ(result.failure, "");
    EXPECT_TRUE(says(result.warnings, "absorptance"));
}
