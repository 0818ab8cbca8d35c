#include "reradiant/colour_of_matrix.h"
#include "reradiant/spectral_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

using namespace reradiant;

// These tests compare with measurements by a Labsphere BFC-450. The data lie beside the source
// tree; where they are absent the tests are skipped.

namespace {

class MeasuredData : public ::testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(folder_ / "HERPIORA.BFC"))
            GTEST_SKIP() << "measured data are not in " << folder_
                         << ": readers and factorisation are NOT checked against measurements";
    }
    ReradiationMatrix read(const std::string& name) const {
        return read_reradiation(folder_ / (name + ".BFC"));
    }
    const std::filesystem::path folder_ =
        std::filesystem::path(RERADIANT_SOURCE_DIR) / ".." / "shared" / "data" / "bfc";
};

MatrixColour under(const ReradiationMatrix& matrix, const char* name) {
    return colour_of_matrix(matrix, illuminant(name),
                            ColourSum::Automatic); // smooth lamps: plain sums
}

void expect_xyz(const MatrixColour& seen, const Xyz& expected) {
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(seen.xyz[c], expected[c], 5.1e-5); // four decimals
}

/// Entries with emission over excitation + 10 nm as a strictly lower triangle: the excitation
/// axis is moved up by one band.
Eigen::MatrixXd beyond_10_nm(const ReradiationMatrix& matrix) {
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(50, 50);
    const int shift = 8; // emission begins at 380, excitation at 300
    for (int o = 0; o < 41; ++o)
        for (int i = 0; i < 49; ++i)
            if (o + shift > i + 1)
                square(o + shift, i + 1) = std::max(0.0, matrix.values(o, i));
    return square;
}

} // namespace

TEST_F(MeasuredData, ColoursAgreeWithAnIndependentCalculation) {
    const ReradiationMatrix orange = read("HERPIORA");
    EXPECT_EQ(orange.kind, MatrixKind::Measured);
    EXPECT_EQ(orange.emission, (WavelengthGrid{380, 10, 41}));
    EXPECT_EQ(orange.excitation, (WavelengthGrid{300, 10, 49}));
    expect_xyz(under(orange, "D65"), {108.0884, 65.5309, 4.3483});
    expect_xyz(under(orange, "A"), {103.8392, 58.7052, 1.5275});
    const MatrixColour seen = under(orange, "D65");
    const auto largest = std::max_element(seen.total.begin(), seen.total.end());
    EXPECT_NEAR(*largest, 2.394, 5e-4);
    EXPECT_EQ(seen.nm[static_cast<std::size_t>(largest - seen.total.begin())], 600.0);
    expect_xyz(under(read("POLGREE"), "D65"), {15.2793, 34.4063, 10.1252});
    expect_xyz(under(read("CIBA12"), "D65"), {85.9624, 88.1373, 115.2975});
}

TEST_F(MeasuredData, EveryFileCanBeRepairedForRendering) {
    for (const char* name :
         {"CIBA12", "CIPLAW10", "HERPICER", "HERPIORA", "IXCRLALE", "PHP8HP1C", "POLGREE"}) {
        ReradiationMatrix matrix = read(name);
        std::vector<std::string> warnings;
        const MatrixRepair repair = repair_for_rendering(matrix, warnings);
        EXPECT_GT(repair.negative_entries, 100) << name;
        EXPECT_GE(matrix.values.minCoeff(), 0.0) << name;
        EXPECT_TRUE(repair_for_rendering(matrix, warnings).text().empty()) << name;
    }
}

TEST_F(MeasuredData, FewTermsFitTheMeasurementsToTheirNoise) {
    struct Known {
        const char* name;
        double rank_1, rank_3;
    };
    // The errors are those of independent fits, to three decimals.
    for (const Known& known : {Known{"HERPIORA", 0.056, 0.033}, {"CIBA12", 0.068, 0.037}}) {
        const Eigen::MatrixXd square = beyond_10_nm(read(known.name));
        EXPECT_NEAR(factorise_lower(square, 1, 0.0).relative_error, known.rank_1, 0.002);
        EXPECT_NEAR(factorise_lower(square, 3, 0.0).relative_error, known.rank_3, 0.002);
    }
}
