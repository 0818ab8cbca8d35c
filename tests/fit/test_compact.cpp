#include "host/fit/factors/knot_choice.h"
#include "host/fit/factors/smooth_basis.h"
#include "reradiant/error.h"
#include "tests/fit/fit_cases.h"

#include <gtest/gtest.h>

using namespace reradiant;

// Curves that keep their values at few bands.

namespace {

FitResult fit_within(const BispectralData& data, int rank, std::optional<std::size_t> bytes) {
    FitSettings settings;
    settings.rank = rank;
    settings.most_bytes = bytes;
    return fit_reradiation(data, settings);
}

/// A curve that is linear between these bands and zero outside.
Eigen::VectorXd polygon(const WavelengthGrid& grid, const std::vector<int>& knots,
                        const std::vector<double>& values) {
    const SmoothBasis basis = hat_basis(grid, knots);
    return basis.values * Eigen::Map<const Eigen::VectorXd>(
                              values.data(), static_cast<Eigen::Index>(values.size()));
}

} // namespace

TEST(Compact, HatsAreLinearBetweenKnotsAndZeroOutside) {
    const Eigen::VectorXd curve = polygon({400.0, 10.0, 9}, {1, 3, 7}, {2.0, 4.0, 0.5});
    const double expected[] = {0.0, 2.0, 3.0, 4.0, 3.125, 2.25, 1.375, 0.5, 0.0};
    for (int band = 0; band < 9; ++band)
        EXPECT_NEAR(curve(band), expected[band], 1e-15) << band;
}

TEST(Compact, KnotsStayWhereACurveBends) {
    FitTarget target;
    target.emission = emission_10_nm();
    target.excitation = excitation_10_nm();
    const std::vector<int> emission{12, 17, 20, 33}, excitation{0, 9, 21, 24, 30};
    const FactorCurves curves{polygon(target.emission, emission, {0.1, 0.4, 1.0, 0.2}),
                              polygon(target.excitation, excitation, {0.3, 0.9, 0.2, 0.6, 0.1})};
    target.value = curves.emission * curves.excitation.transpose();
    target.weight = Eigen::MatrixXd::Ones(41, 49);
    const CurveKnots knots = choose_knots(target, curves, 9);
    EXPECT_EQ(knots.emission, emission);
    EXPECT_EQ(knots.excitation, excitation);
    EXPECT_EQ(numbers_of_positions(target), 3u); // 90 bits
}

TEST(Compact, BytesAreKeptAndLittleIsLost) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    const BispectralData data = noisy_data(truth, 0.01 * stokes_peak(truth), true, 7);
    const FitResult full = fit_within(data, 2, {});
    for (const std::size_t bytes : {std::size_t{480}, std::size_t{400}}) {
        const FitResult compact = fit_within(data, 2, bytes);
        EXPECT_EQ(compact.failure, "");
        EXPECT_LE(compact.bytes, bytes);
        EXPECT_GE(compact.bytes + 8, bytes); // two terms share their knots
        EXPECT_LE(compact.relative_rmse, 1.1 * full.relative_rmse) << bytes;
    }
    EXPECT_EQ(fit_within(data, 2, 5000).bytes, full.bytes);
}

TEST(Compact, TooFewBytesAreRefused) {
    const BispectralData data = noisy_data(true_matrix(two_fluorophores()), 0.01, true, 1);
    EXPECT_THROW(fit_within(data, 2, 43), Error); // 3 numbers of positions, 8 values
    EXPECT_NO_THROW(fit_within(data, 2, 44));
    FitSettings matrix;
    matrix.model = FitModel::Matrix;
    matrix.most_bytes = 200;
    EXPECT_THROW(fit_reradiation(data, matrix), Error);
}
