#include "host/base/output_ending.h"
#include "host/spectral/evidence/matrix_evidence.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "reradiant/spectral_files.h"
#include "tests/support/scratch_folder.h"

#include <cmath>
#include <random>

using namespace reradiant;

namespace {

ReradiationMatrix shipped(const std::string& name) {
    return read_reradiation(std::filesystem::path(RERADIANT_SOURCE_DIR) / "spectra" /
                            "reradiation" / name);
}

/// Returns the matrix as it is read where its off-diagonal values are `factor` times what they
/// should be.
ReradiationMatrix scaled(ReradiationMatrix matrix, double factor) {
    for (int i = 0; i < matrix.excitation.count; ++i)
        for (int o = 0; o < matrix.emission.count; ++o)
            if (o != diagonal_row(matrix, i))
                matrix.values(o, i) *= factor;
    return matrix;
}

void expect_told(const ReradiationMatrix& matrix, const std::string& words) {
    const std::vector<std::string> warnings = matrix_warnings(matrix);
    ASSERT_FALSE(warnings.empty()) << "no word of " << words;
    EXPECT_NE(warnings[0].find(words), std::string::npos) << warnings[0];
}

/// Each misreading of a matrix is told by name.
void expect_misreadings_told(const ReradiationMatrix& matrix) {
    EXPECT_TRUE(matrix_warnings(matrix).empty()) << matrix_warnings(matrix)[0];
    const double step_nm = matrix.excitation.step_nm;
    expect_told(exchanged(matrix), "rows and columns are probably exchanged");
    expect_told(scaled(matrix, 1.0 / step_nm), "'# quantity: density-per-nm'");
    expect_told(scaled(matrix, step_nm), "'# quantity: per-band'");
    ReradiationMatrix dark = matrix;
    dark.values /= 100.0;
    EXPECT_NE(matrix_warnings(dark).back().find("divided by 100"), std::string::npos);
    // Both at once are both told.
    EXPECT_EQ(matrix_warnings(exchanged(scaled(matrix, 1.0 / step_nm))).size(), 2u);
}

} // namespace

TEST(MatrixWarnings, ShippedMatricesAreQuietAndTheirMisreadingsAreTold) {
    for (const char* name : {"synthetic-orange.csv", "synthetic-green.csv"})
        expect_misreadings_told(shipped(name));
}

TEST(MatrixWarnings, MeasuredMatricesAreQuietAndTheirMisreadingsAreTold) {
    const auto folder = std::filesystem::path(RERADIANT_SOURCE_DIR) / ".." / "shared" / "data";
    if (!std::filesystem::exists(folder / "bfc"))
        GTEST_SKIP() << "measured data are not in " << folder
                     << ": thresholds are NOT checked against measurements";
    int files = 0;
    for (const char* part : {"bfc", "icc"})
        for (const auto& entry : std::filesystem::directory_iterator(folder / part))
            if (const std::string ending = lower_case_ending(entry.path());
                ending == ".bfc" || ending == ".csv") {
                SCOPED_TRACE(entry.path());
                expect_misreadings_told(read_reradiation(entry.path()));
                ++files;
            }
    EXPECT_EQ(files, 9);
}

TEST(MatrixWarnings, WhatDoesNotFluoresceIsQuiet) {
    ReradiationMatrix matrix{{400, 10, 31}, {400, 10, 31}, 0.5 * Eigen::MatrixXd::Identity(31, 31)};
    EXPECT_TRUE(matrix_warnings(matrix).empty());
    // Noise on both sides of the diagonal, with sums of either sign.
    for (const double sign : {1.0, -1.0}) {
        for (int o = 0; o < 31; ++o)
            for (int i = 0; i < 31; ++i)
                if (o != i)
                    matrix.values(o, i) = sign * 1e-3 * std::sin(7.3 * o * o + 3.1 * i * i + o * i);
        EXPECT_TRUE(matrix_warnings(matrix).empty()) << matrix_warnings(matrix)[0];
    }
}

/// Instruments cut off what is negative: then noise has a mean, the same on both sides.
TEST(MatrixWarnings, NoiseThatWasCutOffIsNoEmission) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0.0, 1e-3);
        ReradiationMatrix matrix{{400, 10, 31}, {400, 10, 31}, Eigen::MatrixXd::Zero(31, 31)};
        matrix.kind = MatrixKind::Measured;
        matrix.values = matrix.values.unaryExpr([&](double) { return std::abs(noise(random)); });
        matrix.values.diagonal().setConstant(0.8);
        EXPECT_TRUE(matrix_warnings(matrix).empty()) << seed << ": " << matrix_warnings(matrix)[0];
        matrix.values = matrix.values.cwiseMax(5e-4);
        EXPECT_TRUE(matrix_warnings(matrix).empty()) << seed << ": " << matrix_warnings(matrix)[0];
    }
}

TEST(MatrixWarnings, Case26DeclaredAntiStokesEmissionIsBelieved) {
    ReradiationMatrix matrix = exchanged(shipped("synthetic-orange.csv"));
    matrix.anti_stokes_allowed = true;
    for (const std::string& warning : matrix_warnings(matrix))
        EXPECT_EQ(warning.find("exchanged"), std::string::npos) << warning;
}

TEST(MatrixWarnings, EnergyAndPhotonsAreTold) {
    ReradiationMatrix matrix{{400, 10, 31}, {400, 10, 31}, Eigen::MatrixXd::Zero(31, 31)};
    matrix.values(30, 0) = 0.6; // 0.6 * 700 / 400 photons
    matrix.values(0, 0) = 0.3;
    expect_told(matrix, "1 excitation column returns more photons than it receives");
    matrix.values(0, 0) = 0.5;
    expect_told(matrix, "1.1 times the energy");
    matrix.values(30, 0) = std::nan(""); // a gap says nothing
    EXPECT_TRUE(matrix_warnings(matrix).empty());
}

TEST(MatrixWarnings, RefusalsForRenderingNameTheCause) {
    ReradiationMatrix matrix = scaled(shipped("synthetic-orange.csv"), 10.0);
    std::vector<std::string> warnings;
    try {
        repair_for_rendering(matrix, warnings);
        FAIL() << "accepted";
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("declare '# quantity: per-band'"),
                  std::string::npos)
            << error.what();
    }
}
