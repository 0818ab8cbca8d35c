#include "host/spectral/evidence/scatter_detection.h"
#include "host/spectral/evidence/scatter_warnings.h"
#include "tests/spectral/scatter_cases.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <limits>

using namespace reradiant;

namespace {

struct Grids {
    const char* name;
    WavelengthGrid emission, excitation;
};
/// Equal and unequal steps, lattices that hold 2 li and some that do not.
const Grids all_grids[] = {{"10 nm", {380.0, 10.0, 41}, {300.0, 10.0, 49}},
                           {"5 nm", {380.0, 5.0, 81}, {300.0, 5.0, 97}},
                           {"20 nm", {380.0, 20.0, 21}, {300.0, 20.0, 25}},
                           {"six excitations", {420.0, 20.0, 21}, {300.0, 20.0, 6}},
                           {"2 x 5 nm", {400.0, 2.0, 176}, {250.0, 5.0, 41}},
                           {"between bands", {385.0, 10.0, 40}, {300.0, 10.0, 20}},
                           {"10 x 7 nm", {400.0, 10.0, 36}, {280.0, 7.0, 30}},
                           {"nothing but the line", {500.0, 5.0, 50}, {250.0, 5.0, 30}}};

ReradiationMatrix two_dyes(const WavelengthGrid& emission, const WavelengthGrid& excitation) {
    ReradiationMatrix matrix = matrix_from_fluorophores(
        {{Spectrum::gaussian(330.0, 30.0, 0.5), Spectrum::gaussian(450.0, 25.0, 1.0), 0.8},
         {Spectrum::gaussian(400.0, 40.0, 0.4), Spectrum::gaussian(640.0, 30.0, 1.0), 0.7}},
        Spectrum::constant(0.1), emission, excitation);
    matrix.kind = MatrixKind::Measured;
    return matrix;
}

double fluorescent_peak(const ReradiationMatrix& matrix) {
    return matrix.fluorescent_part().maxCoeff();
}

std::vector<FoundScatter> found_in(const ReradiationMatrix& matrix, bool anti_stokes = false) {
    return find_scatter(matrix, {matrix.emission.step_nm, anti_stokes});
}

} // namespace

TEST(ScatterLine, TakesTheBandsThatItReachesInto) {
    const WavelengthGrid emission{580.0, 10.0, 5}, excitation{300.0, 10.0, 1};
    const auto rows = [&](double half_width_nm, double from_nm) {
        WavelengthGrid bands = emission;
        bands.from_nm = from_nm;
        const Eigen::VectorXd on =
            entries_on({ScatterOrder::Second, half_width_nm}, bands, excitation);
        return std::vector<double>(on.data(), on.data() + on.size());
    };
    EXPECT_EQ(rows(1.0, 580.0), (std::vector<double>{0, 0, 1, 0, 0}));
    EXPECT_EQ(rows(5.0, 580.0), (std::vector<double>{0, 0, 1, 0, 0}));
    EXPECT_EQ(rows(10.0, 580.0), (std::vector<double>{0, 1, 1, 1, 0}));
    EXPECT_EQ(rows(15.0, 580.0), (std::vector<double>{0, 1, 1, 1, 0}));
    // 600 nm is the edge between 595 and 605, so both see it.
    EXPECT_EQ(rows(1.0, 585.0), (std::vector<double>{0, 1, 1, 0, 0}));
    EXPECT_EQ(rows(1.0, 583.0), (std::vector<double>{0, 0, 1, 0, 0}));
}

TEST(ScatterLine, LeavesTheDiagonal) {
    const WavelengthGrid grid{400.0, 10.0, 7};
    const Eigen::MatrixXd on = entries_on({ScatterOrder::First, 20.0}, grid, grid);
    for (int i = 0; i < 7; ++i)
        for (int o = 0; o < 7; ++o)
            EXPECT_EQ(on(o, i), o != i && std::abs(o - i) <= 2 ? 1.0 : 0.0) << o << ' ' << i;
    WavelengthGrid between = grid;
    between.from_nm = 405.0; // no band is the diagonal
    EXPECT_EQ(entries_on({ScatterOrder::First, 5.0}, between, grid).col(3).sum(), 2.0);
}

TEST(Scatter, SecondOrderIsFoundOnEveryGrid) {
    std::mt19937 random(1);
    for (const Grids& grids : all_grids)
        for (const double noise : {0.0, 1e-3, 1e-2})
            for (const double fwhm : {2.0, 10.0}) {
                ReradiationMatrix matrix = two_dyes(grids.emission, grids.excitation);
                const double peak = fluorescent_peak(matrix);
                // The height of one band that sees all of a narrow line.
                add_scatter(matrix, 2.0, peak * std::max(1.0, fwhm / grids.emission.step_nm), fwhm);
                add_noise(matrix, noise * peak, random);
                const std::vector<FoundScatter> found = found_in(matrix);
                SCOPED_TRACE(testing::Message()
                             << grids.name << ", noise " << noise << ", width " << fwhm);
                ASSERT_EQ(found.size(), 1u);
                EXPECT_EQ(found[0].line.order, ScatterOrder::Second);
                // All of the triangle that is above the noise, and not much more.
                EXPECT_GE(found[0].line.half_width_nm + 0.5 * grids.emission.step_nm, 0.8 * fwhm);
                EXPECT_LE(found[0].line.half_width_nm, fwhm + 1.5 * grids.emission.step_nm);
                EXPECT_GT(found[0].height, 0.25 * peak);
                EXPECT_LT(found[0].height, 1.2 * peak);
                EXPECT_GE(found[0].entries, 2);
            }
}

TEST(Scatter, DyesAreNoLines) {
    std::mt19937 random(2);
    const int sets = test::is_full_run() ? 100 : 20;
    for (const Grids& grids : all_grids)
        for (const bool narrow : {false, true})
            for (const double noise : {0.0, 1e-3, 1e-2, 5e-2})
                for (int set = 0; set < sets; ++set) {
                    ReradiationMatrix matrix =
                        random_dyes(grids.emission, grids.excitation, narrow, random);
                    add_noise(matrix, noise * matrix.values.maxCoeff(), random);
                    for (const FoundScatter& found : found_in(matrix))
                        ADD_FAILURE() << grids.name << ", noise " << noise << ", set " << set
                                      << ": " << scatter_text(found);
                }
}

TEST(Scatter, EmissionAtTwiceTheExcitationIsNoLine) {
    // Europium's emission is one band wide, and 2 li crosses it at 307 nm.
    ReradiationMatrix europium = matrix_from_fluorophores(
        {{Spectrum::gaussian(310.0, 25.0, 0.7), Spectrum::gaussian(615.0, 2.0, 1.0), 0.8}},
        Spectrum::constant(0.1), all_grids[0].emission, all_grids[0].excitation);
    europium.kind = MatrixKind::Measured;
    EXPECT_TRUE(found_in(europium).empty());
    // A broad band that 2 li runs through.
    ReradiationMatrix red = matrix_from_fluorophores(
        {{Spectrum::gaussian(330.0, 30.0, 0.7), Spectrum::gaussian(660.0, 30.0, 1.0), 0.8}},
        Spectrum::constant(0.1), all_grids[2].emission, all_grids[2].excitation);
    red.kind = MatrixKind::Measured;
    EXPECT_TRUE(found_in(red).empty());
}

TEST(Scatter, OtherOrdersAreFound) {
    const WavelengthGrid emission{200.0, 10.0, 61}, excitation{250.0, 10.0, 36};
    std::mt19937 random(3);
    ReradiationMatrix matrix = two_dyes(emission, excitation);
    add_scatter(matrix, 3.0, 0.05, 2.0);
    add_scatter(matrix, 0.5, 0.05, 2.0);
    add_noise(matrix, 1e-4, random);
    const std::vector<FoundScatter> stokes = found_in(matrix), all = found_in(matrix, true);
    ASSERT_EQ(stokes.size(), 1u);
    EXPECT_EQ(stokes[0].line, (ScatterLine{ScatterOrder::Third, 5.0}));
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].line.order, ScatterOrder::Third);
    EXPECT_EQ(all[1].line.order, ScatterOrder::Half);
}

TEST(Scatter, LightBesideTheDiagonalIsFoundWhereItReachesBeyondTheSpill) {
    const WavelengthGrid emission{380.0, 10.0, 41}, excitation{300.0, 10.0, 49};
    std::mt19937 random(4);
    ReradiationMatrix narrow = two_dyes(emission, excitation), wide = narrow;
    add_scatter(narrow, 1.0, 0.5, 10.0); // one band to each side, as the spill has it
    add_scatter(wide, 1.0, 0.5, 30.0);   // three
    add_noise(narrow, 1e-4, random);
    add_noise(wide, 1e-4, random);
    EXPECT_TRUE(found_in(narrow).empty());
    const std::vector<FoundScatter> found = found_in(wide);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].line, (ScatterLine{ScatterOrder::First, 30.0}));
}

TEST(Scatter, GapsOnAndBesideTheLineDoNotHideIt) {
    ReradiationMatrix matrix = two_dyes(all_grids[0].emission, all_grids[0].excitation);
    std::mt19937 random(5);
    add_scatter(matrix, 2.0, 0.05, 2.0);
    add_noise(matrix, 1e-4, random);
    for (double& value : matrix.values.reshaped())
        if (std::uniform_real_distribution<double>()(random) < 0.2)
            value = std::numeric_limits<double>::quiet_NaN();
    const std::vector<FoundScatter> found = found_in(matrix);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_LT(found[0].entries, 10); // 300 to 390 nm, less the gaps
}

TEST(Scatter, IsAWarningWhereMeasurementsAreUsedAsTheyAre) {
    ReradiationMatrix matrix = two_dyes(all_grids[0].emission, all_grids[0].excitation);
    add_scatter(matrix, 2.0, 0.05, 2.0);
    std::vector<std::string> warnings;
    repair_for_rendering(matrix, warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("second-order scatter at emission = 2 x excitation +- 5 nm"),
              std::string::npos)
        << warnings[0];
    matrix.kind = MatrixKind::Model; // which says that it holds nothing but the sample
    EXPECT_TRUE(scatter_warnings(matrix).empty());
}
