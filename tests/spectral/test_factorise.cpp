#include "reradiant/reradiation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <limits>
#include <random>
#include <stdexcept>

using namespace reradiant;

namespace {

const WavelengthGrid grid{300, 10, 49};

Eigen::MatrixXd lower(const Eigen::MatrixXd& square) {
    return square.triangularView<Eigen::StrictlyLower>();
}

double relative_error(const MaskedFactors& factors, const Eigen::MatrixXd& square) {
    return (lower(factors.emission * factors.excitation.transpose()) - lower(square)).norm() /
           lower(square).norm();
}

/// Pigments with overlapping bands, as dyes of one sample have them.
std::vector<Fluorophore> fluorophores(int count) {
    const std::vector<Fluorophore> all = {
        {Spectrum::gaussian(360, 30, 0.5), Spectrum::gaussian(440, 22, 1.0), 0.8},
        {Spectrum::gaussian(450, 45, 0.4), Spectrum::gaussian(530, 20, 1.0), 0.7},
        {Spectrum::gaussian(500, 50, 0.3), Spectrum::gaussian(600, 25, 1.0), 0.9},
        {Spectrum::gaussian(560, 40, 0.2), Spectrum::gaussian(650, 30, 1.0), 0.6}};
    return {all.begin(), all.begin() + count};
}

} // namespace

TEST(Factorise, ExactProductsOfFluorophoresAreRecovered) {
    // Red of their peaks the factors of these dyes span ten orders of magnitude, and the search
    // ends in flat valleys: 5e-9 at rank 2, 2e-6 at 3 and 1.2e-4 at 4 when this was written.
    for (const auto& [rank, bound] : {std::pair{1, 1e-12}, {2, 1e-6}, {3, 1e-5}, {4, 5e-4}}) {
        const Eigen::MatrixXd values =
            matrix_from_fluorophores(fluorophores(rank), Spectrum::constant(0.1), grid, grid)
                .values;
        const std::clock_t start = std::clock();
        const MaskedFactors factors = factorise_lower(values, rank, 1e-6);
        const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        EXPECT_EQ(factors.rank(), rank);
        EXPECT_LE(factors.relative_error, bound) << rank;
        // Both are sums of rounded products.
        EXPECT_NEAR(relative_error(factors, values), factors.relative_error, 1e-12);
        EXPECT_GE(factors.emission.minCoeff(), 0.0);
        EXPECT_GE(factors.excitation.minCoeff(), 0.0);
        // 1 to 2 s of processor time in a release build; room for debug builds and sanitizers.
        EXPECT_LT(seconds, 60.0) << rank;
        RecordProperty("seconds_rank_" + std::to_string(rank), std::to_string(seconds));
    }
}

TEST(Factorise, ExactProductsOfOverlappingBandsAreRecovered) {
    for (int rank = 1; rank <= 4; ++rank) {
        Eigen::MatrixXd product = Eigen::MatrixXd::Zero(49, 49);
        for (int k = 0; k < rank; ++k) {
            const Spectrum e = Spectrum::gaussian(480 + 75 * k, 30 + 5 * k, 0.3 + 0.2 * k);
            const Spectrum x = Spectrum::gaussian(370 + 60 * k, 40 + 5 * k, 1.0);
            for (int o = 0; o < 49; ++o)
                for (int i = 0; i < 49; ++i)
                    product(o, i) += e(grid.centre_nm(o)) * x(grid.centre_nm(i));
        }
        const MaskedFactors factors = factorise_lower(product, 4, 1e-6);
        EXPECT_EQ(factors.rank(), rank);
        EXPECT_LE(factors.relative_error, 1e-6) << rank;
    }
}

TEST(Factorise, DiagonalAndUpperTriangleAreNotLookedAt) {
    const ReradiationMatrix matrix =
        matrix_from_fluorophores(fluorophores(2), Spectrum(), grid, grid);
    Eigen::MatrixXd changed = matrix.values;
    changed.triangularView<Eigen::Upper>().setConstant(17.0);
    const MaskedFactors a = factorise_lower(matrix.values, 1, 0.0);
    const MaskedFactors b = factorise_lower(changed, 1, 0.0);
    EXPECT_EQ(a.emission, b.emission);
    EXPECT_EQ(a.excitation, b.excitation);
}

TEST(Factorise, ZeroTriangleHasRankZero) {
    const MaskedFactors factors = factorise_lower(Eigen::MatrixXd::Identity(49, 49), 4, 1e-6);
    EXPECT_EQ(factors.rank(), 0);
    EXPECT_EQ(factors.relative_error, 0.0);
    EXPECT_EQ(factors.emission.rows(), 49);
    EXPECT_EQ(factorise_lower(Eigen::MatrixXd(0, 0), 4, 1e-6).rank(), 0);
    EXPECT_EQ(factorise_lower(Eigen::MatrixXd::Ones(1, 1), 4, 1e-6).rank(), 0);
}

TEST(Factorise, ZeroRowsAndColumnsAreOrdinary) {
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(20, 20);
    square(19, 0) = 0.25; // one entry, all else zero
    const MaskedFactors one = factorise_lower(square, 4, 1e-12);
    EXPECT_EQ(one.rank(), 1);
    EXPECT_LE(relative_error(one, square), 1e-12);
    EXPECT_TRUE(one.emission.allFinite() && one.excitation.allFinite());
    const MaskedFactors small = factorise_lower(Eigen::Matrix2d::Constant(0.3), 4, 1e-12);
    EXPECT_EQ(small.rank(), 1);
}

TEST(Factorise, ExtremeScalesNeitherUnderflowNorOverflow) {
    const Eigen::MatrixXd values =
        matrix_from_fluorophores(fluorophores(2), Spectrum(), grid, grid).values;
    for (const double scale : {1e-300, 1e-100, 1e100, 1e300}) {
        const MaskedFactors factors = factorise_lower(values * scale, 2, 1e-6);
        EXPECT_LE(factors.relative_error, 1e-6) << scale;
        EXPECT_TRUE(factors.emission.allFinite() && factors.excitation.allFinite()) << scale;
    }
    Eigen::MatrixXd graded = values; // excitation bands 1e-12 apart in size
    for (int i = 0; i < 49; ++i)
        graded.col(i) *= std::pow(10.0, -6.0 * (i % 3));
    EXPECT_LE(factorise_lower(graded, 3, 1e-6).relative_error, 1e-6);
}

TEST(Factorise, MoreTermsNeverFitWorse) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Eigen::MatrixXd noise(24, 24);
    for (int k = 0; k < noise.size(); ++k)
        noise.data()[k] = uniform(generator);
    double last = 1.0;
    for (int rank = 1; rank <= 4; ++rank) {
        const MaskedFactors factors = factorise_lower(noise, rank, 0.0);
        EXPECT_EQ(factors.rank(), rank);
        EXPECT_LT(factors.relative_error, last);
        last = factors.relative_error;
    }
}

TEST(Factorise, SmallestSufficientRankIsChosen) {
    const Eigen::MatrixXd values =
        matrix_from_fluorophores(fluorophores(3), Spectrum(), grid, grid).values;
    EXPECT_EQ(factorise_lower(values, 4, 0.9).rank(), 1);
    EXPECT_EQ(factorise_lower(values, 2, 1e-9).rank(), 2);
    EXPECT_EQ(factorise_lower(values, 0, 1e-9).rank(), 0);
    EXPECT_EQ(factorise_lower(values, 0, 1e-9).relative_error, 1.0);
}

TEST(Factorise, ImpossibleInputIsRefused) {
    EXPECT_THROW(factorise_lower(Eigen::MatrixXd::Zero(3, 4), 1, 0.1), std::invalid_argument);
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(3, 3);
    square(2, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(factorise_lower(square, 1, 0.1), std::invalid_argument);
    square(2, 0) = 0.1;
    square(0, 2) = std::numeric_limits<double>::quiet_NaN(); // not looked at
    EXPECT_EQ(factorise_lower(square, 1, 0.1).rank(), 1);
}

TEST(Factorise, NegativeNoiseIsFittedByNonNegativeFactors) {
    Eigen::MatrixXd square = Eigen::MatrixXd::Constant(10, 10, -0.5);
    const MaskedFactors factors = factorise_lower(square, 2, 0.0);
    EXPECT_GE(factors.emission.minCoeff(), 0.0);
    EXPECT_NEAR(factors.relative_error, 1.0, 1e-9);
}

TEST(Factorise, FluorophoresBringTheirOwnFactors) {
    std::vector<Fluorophore> dyes = fluorophores(4);
    // absorbs red of its own emission, where the tail that it is scaled by is 1e-200 and less
    dyes.push_back({Spectrum::constant(0.2), Spectrum::gaussian(400, 12, 1.0), 0.9});
    dyes.push_back({Spectrum::gaussian(400, 30, 0.3), Spectrum::gaussian(500, 20, 1.0), 0.0});
    const Eigen::MatrixXd values = matrix_from_fluorophores(dyes, Spectrum(), grid, grid).values;
    const MaskedFactors factors = factors_of_fluorophores(dyes, grid);
    EXPECT_EQ(factors.rank(), 6);
    EXPECT_LE(relative_error(factors, values), 1e-12);
    EXPECT_TRUE(factors.emission.allFinite() && factors.excitation.allFinite());
    EXPECT_GE(factors.excitation.minCoeff(), 0.0);
    EXPECT_EQ(factors.excitation.col(5).maxCoeff(), 0.0); // a yield of 0 sends nothing
    EXPECT_EQ(factors_of_fluorophores({}, grid).rank(), 0);
}
