#include "host/fit/data/noise_estimate.h"
#include "host/fit/data/prepared_target.h"
#include "host/fit/data/rounding_steps.h"
#include "tests/fit/fit_cases.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <filesystem>

using namespace reradiant;

// These tests are of what the numbers of a data set themselves say of their errors.

namespace {

void round_to(BispectralData& data, double step) {
    for (double& value : data.blocks[0].value.reshaped())
        value = step * std::round(value / step);
}

void cut_below_zero(BispectralData& data) {
    for (double& value : data.blocks[0].value.reshaped())
        value = std::max(0.0, value);
}

double rounded_to_digits(double value, double base, int digits) {
    const double unit = std::pow(base, std::floor(std::log(value) / std::log(base)) - digits + 1);
    return unit * std::round(value / unit);
}

Eigen::MatrixXd random_values() {
    std::mt19937 random(1);
    Eigen::MatrixXd values(20, 10);
    for (double& value : values.reshaped())
        value = std::pow(10.0, uniform(random, -3.0, 0.0));
    return values;
}

} // namespace

TEST(RoundingSteps, DecimalsAndLevelsAreSeen) {
    for (const double step : {0.01, 0.001, 0.05, 3.1415926 * 0.002, 1.0 / 4096.0}) {
        Eigen::MatrixXd values = random_values();
        for (double& value : values.reshaped())
            value = step * std::round(value / step);
        const Eigen::MatrixXd steps = rounding_steps(values);
        EXPECT_NEAR(steps.minCoeff() / step, 1.0, 1e-6) << step;
        EXPECT_NEAR(steps.maxCoeff() / step, 1.0, 1e-6) << step;
        const Eigen::MatrixXd single = values.cast<float>().cast<double>();
        EXPECT_NEAR(rounding_steps(single).maxCoeff() / step, 1.0, 1e-3) << step;
    }
}

TEST(RoundingSteps, SignificantDigitsAreSeen) {
    for (const auto& [base, digits] : {std::pair{10.0, 3}, std::pair{2.0, 11}}) {
        Eigen::MatrixXd values = random_values();
        for (double& value : values.reshaped())
            value = rounded_to_digits(value, base, digits);
        values(0) = rounded_to_digits(0.523, base, digits);
        values(1) = rounded_to_digits(0.00152, base, digits);
        const Eigen::MatrixXd steps = rounding_steps(values);
        EXPECT_NEAR(steps(0), base == 10.0 ? 1e-3 : std::exp2(-11), 1e-9) << base;
        EXPECT_NEAR(steps(1), base == 10.0 ? 1e-5 : std::exp2(-20), 1e-9) << base;
    }
}

TEST(RoundingSteps, NumbersThatAreNotRoundedHaveNone) {
    EXPECT_TRUE(rounding_steps(random_values()).isZero(0.0));
    EXPECT_TRUE(rounding_steps(random_values().cast<float>().cast<double>()).isZero(0.0));
    EXPECT_TRUE(rounding_steps(Eigen::MatrixXd::Constant(9, 9, 0.1)).isZero(0.0));
    EXPECT_TRUE(rounding_steps(Eigen::MatrixXd::Zero(9, 9)).isZero(0.0));
}

TEST(NoiseEstimate, TwoDecimalsOfARealTable) {
    const BispectralData data = read_bispectral_data(std::filesystem::path(RERADIANT_SOURCE_DIR) /
                                                     "spectra" / "reradiation" / "neon-orange.csv");
    const FitResult fit = fit_reradiation(data, {});
    EXPECT_EQ(fit.failure, "");
    EXPECT_EQ(fit.shortfall, "");
    EXPECT_NEAR(fit.noise, 0.01 / std::sqrt(12.0), 1e-9);
    EXPECT_TRUE(says(fit.notes, "steps of 0.01"));
    EXPECT_FALSE(says(fit.notes, "no noise"));
    EXPECT_GE(fit.rank, 1);
    EXPECT_LE(fit.rank, 2);
    EXPECT_LE(fit.rmse, 0.005);
}

TEST(NoiseEstimate, RoundingIsInTheBands) {
    const unsigned runs = test::is_full_run() ? 20 : 3;
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    double mean = 0.0;
    for (unsigned seed = 1; seed <= runs; ++seed) {
        BispectralData data = noisy_data(truth, 0.004 * stokes_peak(truth), false, seed);
        round_to(data, 0.02 * stokes_peak(truth));
        const FitResult fit = fit_reradiation(data, {});
        EXPECT_EQ(fit.shortfall, "") << seed;
        EXPECT_EQ(fit.rank, 2) << seed;
        mean += coverage(fit, truth) / runs;
    }
    EXPECT_GE(mean, 0.90);
}

TEST(NoiseEstimate, ThreeDigitsOfEveryEntry) {
    BispectralData data = noisy_data(true_matrix(two_fluorophores()), 0.0, false, 1);
    for (double& value : data.blocks[0].value.reshaped())
        value = value > 1e-12 ? rounded_to_digits(value, 10.0, 3) : 0.0;
    const PreparedTarget prepared = prepare_target(data, {false, 10.0});
    EXPECT_FALSE(says(prepared.notes, "no noise"));
    // The last digit is at least a thousandth of a number.
    Eigen::Index o = 0, i = 0;
    EXPECT_EQ(prepared.target.value.maxCoeff(&o, &i), 1.0);
    EXPECT_LE(prepared.target.weight(o, i), 1e3 * std::sqrt(12.0) * (1.0 + 1e-6));
    EXPECT_GE(prepared.target.weight(o, i), 1e2 * std::sqrt(12.0));
}

TEST(NoiseEstimate, ZerosOfCutOffNoiseAreNoCertainties) {
    const unsigned runs = test::is_full_run() ? 20 : 3;
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    const double noise = 0.02 * stokes_peak(truth);
    double mean = 0.0;
    for (unsigned seed = 1; seed <= runs; ++seed) {
        BispectralData data = noisy_data(truth, noise, false, seed);
        cut_below_zero(data);
        const FitResult fit = fit_reradiation(data, {});
        EXPECT_TRUE(says(fit.notes, "cut off")) << seed;
        EXPECT_EQ(fit.shortfall, "") << seed;
        EXPECT_EQ(fit.rank, 2) << seed; // no third one for what the positive half adds
        EXPECT_NEAR(fit.noise / noise, 1.0, 0.3) << seed;
        mean += coverage(fit, truth) / runs;
    }
    EXPECT_GE(mean, 0.90);
}

TEST(NoiseEstimate, ZerosOfAModelAreWhatTheyAre) {
    BispectralData data = noisy_data(true_matrix({two_fluorophores()[0]}), 0.0, false, 1);
    for (double& value : data.blocks[0].value.reshaped())
        if (value < 1e-4)
            value = 0.0;
    EXPECT_FALSE(says(prepare_target(data, {false, 10.0}).notes, "cut off"));
}

TEST(NoiseEstimate, IsSeenInOneColumn) {
    Eigen::MatrixXd value(41, 1);
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (int o = 0; o < 41; ++o)
        value(o) = std::exp(-0.5 * std::pow((o - 18) / 2.5, 2)) + 0.01 * normal(random);
    // Some 30 differences that share their data know it to a quarter.
    EXPECT_NEAR(estimated_noise(value, Eigen::MatrixXd::Ones(41, 1)) / 0.01, 1.0, 0.6);
}

TEST(Target, RoundedPeakIsNotSaturated) {
    BispectralData data = noisy_data(true_matrix(two_fluorophores()), 0.0, false, 3);
    round_to(data, 0.1 * stokes_peak(true_matrix(two_fluorophores())));
    EXPECT_FALSE(says(prepare_target(data, {false, 10.0}).notes, "saturated"));
    data = noisy_data(true_matrix(two_fluorophores()), 0.0, false, 3);
    round_to(data, 0.02 * stokes_peak(true_matrix(two_fluorophores())));
    const double limit = 0.5 * stokes_peak(true_matrix(two_fluorophores()));
    for (double& value : data.blocks[0].value.reshaped())
        value = std::min(value, limit);
    EXPECT_TRUE(says(prepare_target(data, {false, 10.0}).notes, "saturated"));
}
