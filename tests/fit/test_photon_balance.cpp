#include "tests/fit/fit_cases.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace reradiant;

// Bright whites: their diagonal leaves no more than what is emitted, and is measured with noise.

namespace {

const std::vector<TestFluorophore> one_dye{{450.0, 45.0, 0.7, 560.0, 25.0, 0.7}};
const std::vector<TestFluorophore> two_dyes{{380.0, 30.0, 0.5, 450.0, 22.0, 0.8},
                                            {490.0, 35.0, 0.4, 590.0, 25.0, 0.5}};

double largest_balance(const ReradiationMatrix& matrix) {
    const ColumnBalance balance = column_balance(matrix);
    return std::max(*std::max_element(balance.radiant.begin(), balance.radiant.end()),
                    *std::max_element(balance.photons.begin(), balance.photons.end()));
}

} // namespace

TEST(PhotonBalance, EveryWhiteEndsWithAMatrixAndItsBandsHold) {
    const unsigned sets = test::is_full_run() ? 500 : 6;
    const WavelengthGrid grid{300.0, 10.0, 41};
    for (const auto* dyes : {&one_dye, &two_dyes}) {
        const ReradiationMatrix truth = white_matrix(*dyes, grid, grid);
        double mean = 0.0;
        for (unsigned seed = 1; seed <= sets; ++seed) {
            const FitResult fit =
                fit_reradiation(noisy_data(truth, 0.01 * stokes_peak(truth), false, seed), {});
            EXPECT_EQ(fit.failure, "") << dyes->size() << ' ' << seed;
            EXPECT_EQ(fit.shortfall, "") << dyes->size() << ' ' << seed;
            EXPECT_LE(largest_balance(fit.matrix), 1.0 + 1e-9) << dyes->size() << ' ' << seed;
            mean += coverage(fit, truth) / sets;
        }
        // Entries of one data set are wrong together: six of them waver by some per cent.
        EXPECT_GE(mean, 0.90) << dyes->size();
        EXPECT_LE(mean, test::is_full_run() ? 0.99 : 1.0) << dyes->size();
    }
}

TEST(PhotonBalance, DiagonalGivesWayWithinItsNoise) {
    const WavelengthGrid grid{300.0, 10.0, 41};
    const ReradiationMatrix truth = white_matrix(two_dyes, grid, grid);
    const double noise = 0.01 * stokes_peak(truth);
    const BispectralData data = noisy_data(truth, noise, true, 7);
    for (const FitModel model : {FitModel::Factors, FitModel::Gaussians, FitModel::Matrix}) {
        FitSettings settings;
        settings.model = model;
        if (model != FitModel::Matrix)
            settings.rank = 2;
        const FitResult fit = fit_reradiation(data, settings);
        EXPECT_EQ(fit.failure, "") << fit_model_name(model);
        EXPECT_LE(largest_balance(fit.matrix), 1.0 + 1e-9) << fit_model_name(model);
        EXPECT_TRUE(says(fit.notes, "diagonal entries were lowered")) << fit_model_name(model);
        const Eigen::VectorXd lowered =
            data.blocks[0].value.diagonal().cwiseMin(1.0) - fit.matrix.values.diagonal();
        EXPECT_GE(lowered.minCoeff(), -1e-12) << fit_model_name(model);
        EXPECT_LE(lowered.maxCoeff(), 5.0 * noise) << fit_model_name(model);
    }
}
