#include "reradiant/reradiation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

using namespace reradiant;

namespace {

/// Monochromatic excitation cell at 365 nm, emission line in the cell at 600 nm.
ReradiationMatrix one_shift(double value) {
    ReradiationMatrix matrix{{300, 5, 97}, {300, 5, 97}, Eigen::MatrixXd::Zero(97, 97)};
    matrix.values(matrix.emission.band_of(600), matrix.excitation.band_of(365)) = value;
    return matrix;
}

ReradiationMatrix random_stokes(const WavelengthGrid& emission, const WavelengthGrid& excitation) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(0.0, 0.01);
    ReradiationMatrix matrix{emission, excitation,
                             Eigen::MatrixXd::Zero(emission.count, excitation.count)};
    for (int i = 0; i < excitation.count; ++i)
        for (int o = 0; o < emission.count; ++o)
            if (emission.centre_nm(o) > excitation.centre_nm(i))
                matrix.values(o, i) = uniform(generator);
    return matrix;
}

/// Power that leaves per unit of spectral irradiance over the whole range, in nm.
double total_power_nm(const Eigen::MatrixXd& values, double emission_step_nm) {
    return values.sum() * emission_step_nm;
}

std::string refusal(ReradiationMatrix matrix) {
    std::vector<std::string> warnings;
    try {
        repair_for_rendering(matrix, warnings);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return {};
}

} // namespace

TEST(Reradiation, Case24UnitYieldLosesTheStokesShift) {
    const Fluorophore fluorophore{Spectrum::constant(1.0), Spectrum::line(600, 5, 1), 1.0};
    const WavelengthGrid grid{300, 5, 97};
    const ReradiationMatrix matrix =
        matrix_from_fluorophores({fluorophore}, Spectrum(), grid, grid);
    const ColumnBalance balance = column_balance(matrix);
    const auto i = static_cast<std::size_t>(grid.band_of(365));
    // 365/600; the emission box is 5 nm wide, symmetric in e(l) l to 6e-6.
    EXPECT_NEAR(balance.radiant[i], 365.0 / 600.0, 1e-5);
    EXPECT_NEAR(balance.photons[i], 1.0, 2e-5);
}

TEST(Reradiation, FluorophoreGivesItsFormulaAtWideStokesShifts) {
    const Spectrum excitation = Spectrum::gaussian(400, 25, 0.8);
    const Spectrum emission = Spectrum::gaussian(560, 15, 3.0);
    const WavelengthGrid grid{300, 1, 481};
    const ReradiationMatrix matrix = matrix_from_fluorophores({{excitation, emission, 0.7}},
                                                              Spectrum::constant(0.1), grid, grid);
    // integral e l dl of a Gaussian: peak * centre * sigma sqrt(2 pi); nothing lies below 400 nm.
    const double normal = 3.0 * 560 * 15 * std::sqrt(2 * 3.14159265358979323846);
    const double expected = 0.7 * 0.8 * 400 * 3.0 * std::exp(-0.5 * 100.0 / 225.0) / normal;
    // 1 nm cells of bands 15 nm wide: second-order means differ by (1/15)^2 / 24 = 2e-4.
    EXPECT_NEAR(matrix.values(grid.band_of(570), grid.band_of(400)) / expected, 1.0, 3e-4);
    EXPECT_EQ(matrix.values(grid.band_of(500), grid.band_of(520)), 0.0);
    EXPECT_DOUBLE_EQ(matrix.values(grid.band_of(700), grid.band_of(700)), 0.1);
}

TEST(Reradiation, FluorophorePhotonsAreItsYieldWhereverItAbsorbs) {
    const Fluorophore fluorophore{Spectrum::constant(0.9), Spectrum::gaussian(560, 20, 1), 0.8};
    const WavelengthGrid emission{300, 10, 61}, excitation{300, 10, 31};
    const ColumnBalance balance =
        column_balance(matrix_from_fluorophores({fluorophore}, Spectrum(), emission, excitation));
    // Also inside the emission band, where only what lies above the excitation is emitted. Band
    // centres stand for their cells: (10 nm / 20 nm)^2 / 12 of a small shift, and the diagonal.
    for (const double photons : balance.photons)
        EXPECT_NEAR(photons, 0.72, 0.005);
}

TEST(Reradiation, FluorophoresStayFiniteFarInTheTail) {
    const Fluorophore fluorophore{Spectrum::constant(1.0), Spectrum::gaussian(400, 5, 1), 1.0};
    const WavelengthGrid grid{300, 10, 49};
    const ReradiationMatrix matrix =
        matrix_from_fluorophores({fluorophore}, Spectrum(), grid, grid);
    EXPECT_TRUE(matrix.values.allFinite());
    EXPECT_GE(matrix.values.minCoeff(), 0.0);
    for (const double radiant : column_balance(matrix).radiant)
        EXPECT_LE(radiant, 1.0);
}

TEST(Reradiation, FluorophoreThatIsNoneIsRefused) {
    const WavelengthGrid grid{300, 10, 49};
    const Spectrum half = Spectrum::constant(0.5);
    const auto make = [&](const Fluorophore& f) {
        return matrix_from_fluorophores({f}, Spectrum(), grid, grid);
    };
    EXPECT_THROW(make({Spectrum::constant(1.5), half, 1.0}), std::invalid_argument);
    EXPECT_THROW(make({Spectrum::constant(-0.5), half, 1.0}), std::invalid_argument);
    EXPECT_THROW(make({half, Spectrum::constant(-1), 1.0}), std::invalid_argument);
    EXPECT_THROW(make({half, half, -0.1}), std::invalid_argument);
    EXPECT_THROW(make({half, half, std::nan("")}), std::invalid_argument);
    EXPECT_TRUE((make({half, Spectrum(), 1.0}).values.array() == 0.0).all());
}

TEST(Reradiation, FluorophoreMatrixHardlyDependsOnTheGrid) {
    const Fluorophore fluorophore{Spectrum::gaussian(440, 40, 0.9), Spectrum::gaussian(520, 20, 1),
                                  0.9};
    const WavelengthGrid fine{300.5, 1, 480}, coarse{305, 10, 48};
    const auto of = [&](const WavelengthGrid& grid) {
        return matrix_from_fluorophores({fluorophore}, Spectrum(), grid, grid);
    };
    // Both integrate the same F exactly over cells that nest: the same total power.
    const double a = total_power_nm(of(fine).values, 1) * 1.0,
                 b = total_power_nm(of(coarse).values, 10);
    EXPECT_NEAR(a / b, 1.0, 1e-5);
}

TEST(Reradiation, DiagonalIsFoundOnlyWhereCentresCoincide) {
    const ReradiationMatrix matrix{{380, 10, 41}, {300, 5, 97}, Eigen::MatrixXd::Zero(41, 97)};
    EXPECT_EQ(diagonal_row(matrix, 0), -1);
    EXPECT_EQ(diagonal_row(matrix, 16), 0);
    EXPECT_EQ(diagonal_row(matrix, 17), -1);
    EXPECT_EQ(diagonal_row(matrix, 18), 1);
    EXPECT_EQ(diagonal_row(matrix, 96), 40);
}

TEST(Reradiation, ReflectanceAndFluorescenceAreTakenApart) {
    ReradiationMatrix matrix{{400, 10, 3}, {390, 10, 4}, Eigen::MatrixXd::Zero(3, 4)};
    matrix.values << 0.01, 0.2, 0, 0, 0.02, 0.03, 0.3, 0, 0.04, 0.05, 0.06, 0.4;
    EXPECT_DOUBLE_EQ(matrix.reflectance()(400), 0.2);
    EXPECT_DOUBLE_EQ(matrix.reflectance()(405), 0.25);
    EXPECT_DOUBLE_EQ(matrix.reflectance()(300), 0.2);
    EXPECT_EQ(matrix.fluorescent_part()(1, 2), 0.0);
    EXPECT_EQ(matrix.fluorescent_part()(2, 2), 0.06);
    EXPECT_TRUE(matrix.is_fluorescent());
    matrix.values = Eigen::MatrixXd::Zero(3, 4);
    matrix.values(0, 1) = 0.5;
    EXPECT_FALSE(matrix.is_fluorescent());
}

TEST(Reradiation, BalanceConvertsStepsButNotTheDiagonal) {
    ReradiationMatrix matrix{{400, 5, 3}, {400, 10, 1}, Eigen::MatrixXd::Zero(3, 1)};
    matrix.values << 0.3, 0.2, 0.4;
    const ColumnBalance balance = column_balance(matrix);
    EXPECT_NEAR(balance.radiant[0], 0.3 + 0.5 * (0.2 + 0.4), 1e-15);
    EXPECT_NEAR(balance.photons[0], 0.3 + 0.5 * (0.2 * 405 / 400 + 0.4 * 410 / 400), 1e-15);
}

TEST(Reradiation, Case25EnergyGainIsRefusedNamingTheColumn) {
    EXPECT_NE(refusal(one_shift(1.001)).find("365"), std::string::npos);
    EXPECT_EQ(refusal(one_shift(1.0)), "");
    ReradiationMatrix measured = one_shift(1.001);
    measured.kind = MatrixKind::Measured;
    EXPECT_NE(refusal(measured).find("365"), std::string::npos);
}

TEST(Reradiation, Case25SmallNegativesAreClampedAndReported) {
    ReradiationMatrix matrix = one_shift(0.5);
    matrix.values(96, 0) = -1e-9;
    std::vector<std::string> warnings;
    const MatrixRepair repair = repair_for_rendering(matrix, warnings);
    EXPECT_EQ(repair.negative_entries, 1);
    EXPECT_NEAR(repair.negative_energy, 2e-9, 1e-20);
    EXPECT_EQ(matrix.values(96, 0), 0.0);
    EXPECT_NE(repair.text().find("1 negative"), std::string::npos);
    matrix.values(96, 0) = -1e-3;
    EXPECT_NE(refusal(matrix).find("negative"), std::string::npos);
    matrix.kind = MatrixKind::Measured;
    EXPECT_EQ(refusal(matrix), "");
}

TEST(Reradiation, Case26AntiStokesNeedsLeave) {
    ReradiationMatrix matrix = one_shift(0.5);
    matrix.values(0, 1) = 1e-4;
    EXPECT_NE(refusal(matrix).find("anti-Stokes"), std::string::npos);
    matrix.anti_stokes_allowed = true;
    EXPECT_EQ(refusal(matrix), "");
    matrix.anti_stokes_allowed = false;
    matrix.kind = MatrixKind::Measured;
    std::vector<std::string> warnings;
    const MatrixRepair repair = repair_for_rendering(matrix, warnings);
    EXPECT_EQ(repair.anti_stokes_entries, 1);
    EXPECT_NEAR(repair.anti_stokes_energy, 1e-4 / 0.5001, 1e-15);
    EXPECT_EQ(matrix.values(0, 1), 0.0);
}

TEST(Reradiation, PhotonGainIsAWarning) {
    ReradiationMatrix matrix = one_shift(0.7); // 0.7 * 600 / 365 = 1.15 photons
    std::vector<std::string> warnings;
    EXPECT_TRUE(repair_for_rendering(matrix, warnings).text().empty());
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("365"), std::string::npos);
}

TEST(Reradiation, NotANumberIsRefused) {
    ReradiationMatrix matrix = one_shift(0.5);
    matrix.values(3, 3) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal(matrix).find("finite"), std::string::npos);
    matrix.values.resize(3, 3);
    EXPECT_NE(refusal(matrix), "");
}

TEST(Reradiation, Case27RebinningKeepsThePower) {
    const ReradiationMatrix matrix = random_stokes({380, 10, 41}, {300, 10, 49});
    const double power = total_power_nm(matrix.values, 10);
    for (const WavelengthGrid& cells :
         {WavelengthGrid{250, 1, 601}, {250, 5, 121}, {250, 10, 61}, {253.7, 7.3, 90}}) {
        const Eigen::MatrixXd on_cells = fluorescence_on_cells(matrix, cells);
        // values are F * dmu, so the sum over excitation is an integral over the whole range.
        EXPECT_NEAR(total_power_nm(on_cells, cells.step_nm) / power, 1.0, 1e-12) << cells.step_nm;
    }
}

TEST(Reradiation, RebinningKeepsThePowerOfUnequalSteps) {
    const ReradiationMatrix matrix = random_stokes({380, 5, 81}, {300, 10, 49});
    const double power = total_power_nm(matrix.fluorescent_part(), 5);
    const Eigen::MatrixXd on_cells = fluorescence_on_cells(matrix, {250, 3, 200});
    EXPECT_NEAR(total_power_nm(on_cells, 3) / power, 1.0, 1e-12);
}

TEST(Reradiation, RebinningOntoTheSameCellsChangesNothing) {
    const WavelengthGrid grid{300, 10, 49};
    const ReradiationMatrix matrix = random_stokes(grid, grid);
    EXPECT_LT((fluorescence_on_cells(matrix, grid) - matrix.values).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Reradiation, RebinningNeverMovesEnergyAboveTheDiagonal) {
    const WavelengthGrid grid{300, 10, 49};
    const ReradiationMatrix matrix = random_stokes(grid, grid);
    const Eigen::MatrixXd on_cells = fluorescence_on_cells(matrix, {303.3, 7, 70});
    EXPECT_EQ(
        Eigen::MatrixXd(on_cells.triangularView<Eigen::StrictlyUpper>()).cwiseAbs().maxCoeff(),
        0.0);
}

TEST(Reradiation, EnergyWithinACoarseCellLandsOnItsDiagonal) {
    ReradiationMatrix matrix{{400, 1, 10}, {400, 1, 10}, Eigen::MatrixXd::Zero(10, 10)};
    matrix.values(7, 2) = 0.3;
    const Eigen::MatrixXd on_cells = fluorescence_on_cells(matrix, {404.5, 10, 1});
    // One of ten excitation nanometres, into one of ten emission nanometres.
    EXPECT_NEAR(on_cells(0, 0), 0.3 / 10.0, 1e-15);
}
