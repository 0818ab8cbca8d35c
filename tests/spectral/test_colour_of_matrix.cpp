#include "reradiant/colour_of_matrix.h"

#include "host/spectral/colour/lamp.h"
#include "host/spectral/colour/lamp_colours.h"
#include "reradiant/spectral_files.h"
#include "tests/spectral/synthetic_recipes.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

using namespace reradiant;

namespace {

constexpr const char* lamps[] = {"A", "D65", "FL2", "LED-B3"};

ReradiationMatrix shipped(const std::string& name) {
    return read_reradiation(std::filesystem::path(RERADIANT_SOURCE_DIR) / "spectra" /
                            "reradiation" / name);
}

MatrixColour colour_under(const ReradiationMatrix& matrix, const std::string& name,
                          ColourSum sum = ColourSum::Bands) {
    return colour_of_matrix(matrix, illuminant(name), sum);
}

/// A paint that only reflects, from 360 to 780 nm in 10 nm steps.
ReradiationMatrix reflecting(const std::function<double(double)>& reflectance) {
    ReradiationMatrix matrix;
    matrix.emission = matrix.excitation = {360.0, 10.0, 43};
    matrix.values.setZero(43, 43);
    for (int band = 0; band < 43; ++band)
        matrix.values(band, band) = reflectance(matrix.emission.centre_nm(band));
    return matrix;
}

void expect_near(const std::array<double, 3>& seen, const std::array<double, 3>& expected,
                 double tolerance, const std::string& what) {
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[c], expected[c], tolerance) << what << ", component " << c;
}

} // namespace

// Numbers of colour-science 0.4.7 (its tables of illuminants and of the observer, its Lab, CIE 2004
// whiteness, CIEDE2000), the matrix product by numpy; printed with six decimals. Its tables and
// ours hold the same digits, so only the order of sums differs.
TEST(ColourOfMatrix, AgreesWithColourScience) {
    const std::array<Xyz, 4> xyz = {Xyz{101.631143, 58.807389, 1.482706},
                                    {126.797302, 77.543911, 4.445695},
                                    {88.879941, 56.237341, 2.299985},
                                    {95.316112, 58.089574, 2.770893}};
    const std::array<std::array<double, 3>, 4> lab = {{{81.185608, 68.32947, 98.200876},
                                                       {90.571372, 91.112457, 114.862593},
                                                       {79.748706, 69.940929, 95.999777},
                                                       {80.788566, 73.471762, 97.923203}}};
    const std::array<double, 4> to_green = {70.8521623698, 83.9540323002, 70.0996969074,
                                            73.4142650267};
    const ReradiationMatrix orange = shipped("synthetic-orange.csv");
    const ReradiationMatrix green = shipped("synthetic-green.csv");
    for (std::size_t k = 0; k < 4; ++k) {
        const MatrixColour colour = colour_under(orange, lamps[k]);
        expect_near(colour.xyz, xyz[k], 1e-6, lamps[k]);
        expect_near(colour.lab, lab[k], 2e-6, lamps[k]);
        EXPECT_NEAR(ciede2000(colour.lab, colour_under(green, lamps[k]).lab), to_green[k], 1e-6);
    }
    EXPECT_NEAR(colour_under(orange, "D65").xy[0], 0.6073049, 1e-7);
    EXPECT_NEAR(colour_under(orange, "D65").xy[1], 0.3714022, 1e-7);
}

TEST(ColourOfMatrix, WhitenessAgreesWithColourScience) {
    const MatrixColour orange = colour_under(shipped("synthetic-orange.csv"), "D65");
    const Whiteness far = cie_whiteness(orange.xyz, orange.white);
    EXPECT_NEAR(far.whiteness, -230.00753, 1e-5);
    EXPECT_NEAR(far.tint, -267.09322, 1e-5);
    EXPECT_FALSE(far.within_limits);
    // By its definition the perfect diffuser has whiteness 100 and no tint.
    const Whiteness white = cie_whiteness(orange.white, orange.white);
    EXPECT_DOUBLE_EQ(white.whiteness, 100.0);
    EXPECT_DOUBLE_EQ(white.tint, 0.0);
    EXPECT_TRUE(white.within_limits);
}

// The expected colours are those of the weights that colour-science 0.4.7 makes by ASTM E2022 for
// the same 10 nm bands, from its illuminants interpolated linearly to 1 nm as CIE 15 asks, A from
// its formula (our table of A has six digits, hence its tolerance). Both sums run from 360 to 780
// nm.
TEST(ColourOfMatrix, E308AgreesWithColourScienceForReflection) {
    const std::array<Xyz, 4> expected = {Xyz{62.208689, 34.721118, 1.453616},
                                         {40.74055, 24.734362, 4.379319},
                                         {42.399267, 27.812214, 2.724414},
                                         {48.048764, 29.187569, 2.734783}};
    const std::array<Xyz, 4> white = {Xyz{109.849568, 100, 35.585103},
                                      {95.046857, 100, 108.882973},
                                      {99.14607, 100, 67.314818},
                                      {100.861889, 100, 67.63394}};
    const Spectrum diagonal = shipped("synthetic-orange.csv").reflectance();
    const ReradiationMatrix paint = reflecting([&](double nm) { return diagonal(nm); });
    for (std::size_t k = 0; k < 4; ++k) {
        const MatrixColour colour = colour_under(paint, lamps[k], ColourSum::E308);
        const double tolerance = k == 0 ? 5e-5 : 2e-6;
        expect_near(colour.xyz, expected[k], tolerance, lamps[k]);
        expect_near(colour.white, white[k], tolerance, lamps[k]);
    }
}

TEST(ColourOfMatrix, E308ReproducesCubicsBetweenTheBands) {
    // Lagrange's cubic is exact for polynomials of degree 3 inside and 2 at the ends, so bands of
    // 10 nm and of 5 nm give one colour for a parabola.
    const auto parabola = [](double nm) { return 0.3 + 1e-5 * (nm - 500.0) * (nm - 520.0); };
    const ReradiationMatrix coarse = reflecting(parabola);
    ReradiationMatrix fine;
    fine.emission = fine.excitation = {360.0, 5.0, 85};
    fine.values.setZero(85, 85);
    for (int band = 0; band < 85; ++band)
        fine.values(band, band) = parabola(fine.emission.centre_nm(band));
    for (const char* lamp : lamps)
        expect_near(colour_under(fine, lamp, ColourSum::E308).xyz,
                    colour_under(coarse, lamp, ColourSum::E308).xyz, 1e-9, lamp);
}

TEST(ColourOfMatrix, E308CountsAMercuryLineThatNoBandCentreHits) {
    // Both sums agree for a smooth illuminant, to what 10 nm bands resolve of this fluorophore
    // (0.02 of 77); FL2's lines at 405 and 436 nm lie between band centres.
    const ReradiationMatrix orange = shipped("synthetic-orange.csv");
    const double smooth = std::abs(colour_under(orange, "D65").xyz[1] -
                                   colour_under(orange, "D65", ColourSum::E308).xyz[1]);
    const double lines = std::abs(colour_under(orange, "FL2").xyz[1] -
                                  colour_under(orange, "FL2", ColourSum::E308).xyz[1]);
    EXPECT_LT(smooth, 0.1);
    EXPECT_GT(lines, 10.0 * smooth);
}

// The sigmoid 0.05 + 0.85 / (1 + exp(-(l - 590) / 12)) on bands of 10 nm from 380 nm. Sums over 1
// nm of its values interpolated linearly, with the CIE's FL11 and observer, have Y = 29.4327, plain
// sums 31.5634; a cubic between the bands is nearer to the sigmoid than a line, by 0.02.
TEST(ColourOfMatrix, LampsWithLinesAreSummedOverNanometres) {
    ReradiationMatrix paint;
    paint.emission = paint.excitation = {380.0, 10.0, 41};
    paint.values.setZero(41, 41);
    for (int band = 0; band < 41; ++band)
        paint.values(band, band) =
            0.05 + 0.85 / (1.0 + std::exp(-(paint.emission.centre_nm(band) - 590.0) / 12.0));
    EXPECT_NEAR(colour_under(paint, "FL11").xyz[1], 31.5634, 1e-3);
    const MatrixColour lines = colour_under(paint, "FL11", ColourSum::Automatic);
    EXPECT_TRUE(lines.at_nanometres);
    EXPECT_NE(lines.reason.find("white (Z)"), std::string::npos) << lines.reason;
    EXPECT_NEAR(lines.xyz[1], 29.42, 0.02);
    expect_near(lines.xyz, colour_under(paint, "FL11", ColourSum::E308).xyz, 1e-12, "FL11");
    for (const char* smooth : {"A", "C", "D50", "D65", "LED-B3", "E"}) {
        const MatrixColour colour = colour_under(paint, smooth, ColourSum::Automatic);
        EXPECT_FALSE(colour.at_nanometres) << smooth << ": " << colour.reason;
        EXPECT_TRUE(colour.reason.empty());
        expect_near(colour.xyz, colour_under(paint, smooth).xyz, 0.0, smooth);
    }
    for (const char* spiky : {"FL2", "FL7", "FL12", "HP1", "LED-V1"})
        EXPECT_TRUE(colour_under(paint, spiky, ColourSum::Automatic).at_nanometres) << spiky;
}

TEST(ColourOfMatrix, BandsThatMissALineMissNoneOfIt) {
    // The reflectance is a parabola, so that a line's share is known wherever it lies. 546.07 nm is
    // mercury's; a tenth of a nanometre wide, a sum over whole nanometres could miss it, too.
    const auto parabola = [](double nm) { return 0.3 + 1e-5 * (nm - 500.0) * (nm - 520.0); };
    const ReradiationMatrix paint = reflecting(parabola);
    for (const double centre : {436.5, 546.07, 578.2})
        for (const double width : {0.1, 1.0, 3.0}) {
            const MatrixColour colour =
                colour_of_matrix(paint, Spectrum::line(centre, width, 1.0), ColourSum::Automatic);
            EXPECT_TRUE(colour.at_nanometres);
            EXPECT_NEAR(colour.xyz[1], 100.0 * parabola(centre), 0.15) << centre << " " << width;
        }
    // The table has the line at 546.1 nm too, in steps finer than 1 nm.
    const Spectrum table =
        Spectrum::table({400.0, 546.0, 546.1, 546.2, 700.0}, {0.0, 0.0, 1.0, 0.0, 0.0});
    EXPECT_NEAR(colour_of_matrix(paint, table, ColourSum::Automatic).xyz[1],
                100.0 * parabola(546.1), 0.15);
}

TEST(ColourOfMatrix, AnInvisibleLineThatExcitesCounts) {
    // Mercury's 365 nm lies between the centres of 10 nm bands, and the eye sees none of it.
    Spectrum lamp = illuminant("D65");
    lamp += Spectrum::line(365.0, 1.0, 4000.0);
    const MatrixColour colour =
        colour_of_matrix(shipped("synthetic-orange.csv"), lamp, ColourSum::Automatic);
    EXPECT_TRUE(colour.at_nanometres);
    EXPECT_NE(colour.reason.find("fluorescence"), std::string::npos) << colour.reason;
    EXPECT_GT(colour.xyz[1], 1.01 * colour_under(shipped("synthetic-orange.csv"), "D65").xyz[1]);
}

TEST(ColourOfMatrix, FewBandsAreSummedWithinTheirOwnRange) {
    // White stays white on any range, and a grey stays grey.
    ReradiationMatrix grey;
    grey.emission = grey.excitation = {520.0, 10.0, 8};
    grey.values = 0.4 * Eigen::MatrixXd::Identity(8, 8);
    const MatrixColour colour = colour_under(grey, "FL11", ColourSum::Automatic);
    EXPECT_TRUE(colour.at_nanometres);
    EXPECT_NEAR(colour.xyz[1], 40.0, 1e-9);
    EXPECT_LT(colour.white[2], 2.0) << "as of the bands, which see no blue";
}

TEST(ColourOfMatrix, RadianceFactorsOfALampWithLinesAreThoseOfItsMeanLight) {
    // A line in the band of 550 nm, off its centre: a factor against the light at the centre alone
    // would be infinite there.
    Spectrum lamp = Spectrum::constant(1.0);
    lamp += Spectrum::line(546.0, 1.0, 100.0);
    const ReradiationMatrix orange = shipped("synthetic-orange.csv");
    const MatrixColour plain = colour_of_matrix(orange, lamp, ColourSum::Bands);
    const MatrixColour mean = colour_of_matrix(orange, lamp, ColourSum::Automatic);
    ASSERT_TRUE(mean.at_nanometres);
    const std::size_t band = 25; // 550 nm, from 300
    ASSERT_DOUBLE_EQ(mean.nm[band], 550.0);
    // 11 times the light, and fluorescence from shorter wavelengths as before, but for the part of
    // the line that counts as excitation at 540 nm.
    EXPECT_GE(mean.luminescent[band], plain.luminescent[band] / 11.0);
    EXPECT_LT(mean.luminescent[band], 1.3 * plain.luminescent[band] / 11.0);
}

TEST(ColourOfMatrix, RadianceFactorsAddUp) {
    const MatrixColour colour = colour_under(shipped("synthetic-orange.csv"), "D65");
    ASSERT_EQ(colour.nm.size(), 49u);
    double largest = 0.0;
    for (std::size_t o = 0; o < colour.nm.size(); ++o) {
        EXPECT_DOUBLE_EQ(colour.total[o], colour.reflected[o] + colour.luminescent[o]);
        largest = std::max(largest, colour.total[o]);
    }
    EXPECT_NEAR(largest, 2.63815340172, 1e-10); // numpy, as above
    EXPECT_GT(colour.luminance_reflected, 0.0);
    EXPECT_LT(colour.luminance_reflected, colour.xyz[1]);
}

TEST(ColourOfMatrix, WhiteStaysWhite) {
    const ReradiationMatrix white = reflecting([](double) { return 1.0; });
    for (const char* lamp : lamps)
        for (const ColourSum sum : {ColourSum::Bands, ColourSum::E308}) {
            const MatrixColour colour = colour_under(white, lamp, sum);
            expect_near(colour.xyz, colour.white, 1e-12, lamp);
            expect_near(colour.lab, {100.0, 0.0, 0.0}, 1e-10, lamp);
            EXPECT_NEAR(colour.luminance_reflected, 100.0, 1e-12);
        }
}

TEST(ColourOfMatrix, DarkBandsHaveNoRadianceFactor) {
    // FL2's table begins at 380 nm.
    const MatrixColour colour = colour_under(shipped("synthetic-orange.csv"), "FL2");
    EXPECT_TRUE(std::isnan(colour.total[0]));
    EXPECT_FALSE(std::isnan(colour.total[8]));
    EXPECT_FALSE(std::isnan(colour.reflected[0]));
}

TEST(ColourOfMatrix, RawValuesCountAsTheyAre) {
    ReradiationMatrix matrix = reflecting([](double) { return 0.5; });
    matrix.kind = MatrixKind::Measured;
    const double before = colour_under(matrix, "E").xyz[1];
    matrix.values(19, 25) = -0.25; // anti-Stokes and negative: 610 to 550 nm
    const ColourMatching& eye = cie_1931_2_degree();
    double white = 0.0;
    for (int band = 0; band < 43; ++band)
        white += eye.y[10 * static_cast<std::size_t>(band)];
    EXPECT_NEAR(colour_under(matrix, "E").xyz[1], before - 25.0 * eye.y[190] / white, 1e-10);
}

TEST(ColourOfMatrix, WarnsOfUnlitExcitationAndOfUnknownReflectance) {
    const ReradiationMatrix orange = shipped("synthetic-orange.csv");
    EXPECT_TRUE(colour_warnings(orange, illuminant("D65"), "D65").empty());
    const auto lamp = colour_warnings(orange, illuminant("FL2"), "FL2");
    ASSERT_EQ(lamp.size(), 1u);
    EXPECT_NE(lamp[0].find("starts at 380 nm"), std::string::npos) << lamp[0];
    EXPECT_NE(lamp[0].find("8 excitation bands from 300 nm"), std::string::npos) << lamp[0];
    ReradiationMatrix cut = orange;
    cut.excitation.count = 31; // to 600 nm
    cut.values = Eigen::MatrixXd(orange.values.leftCols(31));
    const auto unknown = colour_warnings(cut, illuminant("D65"), "D65");
    ASSERT_EQ(unknown.size(), 1u);
    EXPECT_NE(unknown[0].find("300 to 600 nm"), std::string::npos) << unknown[0];
}

TEST(ColourOfMatrix, WarnsOfALampThatEndsWithinTheExcitation) {
    const ReradiationMatrix orange = shipped("synthetic-orange.csv");
    const Spectrum blue = cut_to(Spectrum::constant(1.0), 300.0, 480.0);
    const auto warnings = colour_warnings(orange, blue, "blue.csv");
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("blue.csv ends at 480 nm"), std::string::npos) << warnings[0];
    const Eigen::MatrixXd fluorescence = orange.fluorescent_part();
    const double dark = fluorescence.rightCols(30).sum() / fluorescence.sum(); // from 490 nm on
    EXPECT_NE(warnings[0].find(fmt::format("({:.3g} % of what", 100.0 * dark)), std::string::npos)
        << warnings[0];
}

// The sums are kept between matrices, and grids do not mix.
TEST(ColourOfMatrix, ManyMatricesShareTheirSums) {
    const std::vector<ReradiationMatrix> all = {
        shipped("synthetic-orange.csv"), shipped("neon-yellow.csv"),
        reflecting([](double nm) { return nm / 1000.0; }), shipped("synthetic-green.csv")};
    for (const char* lamp : {"D65", "FL11"}) {
        LampColours colours(illuminant(lamp), ColourSum::Automatic);
        for (int round = 0; round < 2; ++round)
            for (const ReradiationMatrix& matrix : all) {
                const MatrixColour shared = colours.colour_of(matrix);
                const MatrixColour alone = colour_under(matrix, lamp, ColourSum::Automatic);
                EXPECT_EQ(shared.xyz, alone.xyz);
                EXPECT_EQ(shared.reflected, alone.reflected);
                EXPECT_EQ(shared.reason, alone.reason);
            }
    }
}

TEST(ColourOfMatrix, WarnsOfWhiteThatTheBandsDoNotSee) {
    ReradiationMatrix cut;
    cut.emission = cut.excitation = {380.0, 10.0, 19}; // to 560 nm
    cut.values = 0.5 * Eigen::MatrixXd::Identity(19, 19);
    const auto warnings = colour_warnings(cut, illuminant("E"), "E");
    ASSERT_EQ(warnings.size(), 1u);
    const ColourMatching& eye = cie_1931_2_degree();
    double beyond = 0.0, whole = 0.0; // sums of X, most of which lies in the red
    for (std::size_t k = 0; k <= 420; ++k) {
        whole += eye.x[k];
        if (k > 205 || k < 15)
            beyond += eye.x[k];
    }
    EXPECT_NE(warnings[0].find(fmt::format("{:.3g} % of the white", 100.0 * beyond / whole)),
              std::string::npos)
        << warnings[0];
    // From 400 to 700 nm the standards carry the ends on.
    cut.emission = cut.excitation = {400.0, 20.0, 16};
    cut.values = 0.5 * Eigen::MatrixXd::Identity(16, 16);
    EXPECT_TRUE(colour_warnings(cut, illuminant("E"), "E").empty());
    ReradiationMatrix apart;
    apart.excitation = {300.0, 10.0, 11};
    apart.emission = {420.0, 10.0, 31};
    apart.values = Eigen::MatrixXd::Constant(31, 11, 0.01);
    const auto unknown = colour_warnings(apart, illuminant("E"), "E");
    ASSERT_FALSE(unknown.empty());
    EXPECT_NE(unknown[0].find("reflectance is not known and counts as 0"), std::string::npos)
        << unknown[0];
}

TEST(ColourOfMatrix, BandsOutsideTheVisibleAreRefused) {
    ReradiationMatrix infrared;
    infrared.emission = infrared.excitation = {900.0, 10.0, 3};
    infrared.values.setIdentity(3, 3);
    EXPECT_THROW(colour_under(infrared, "D65"), std::invalid_argument);
}

TEST(ColourOfMatrix, NoRadianceFactorWhereTheLampIsDark) {
    // The tail of the lamp is 1e-300 at 600 nm, where the orange shines.
    const Spectrum lamp = Spectrum::gaussian(405.0, 5.0, 1.0);
    const MatrixColour colour =
        colour_of_matrix(shipped("synthetic-orange.csv"), lamp, ColourSum::Bands);
    int undefined = 0;
    for (const double factor : colour.total) {
        undefined += std::isnan(factor) ? 1 : 0;
        EXPECT_FALSE(std::abs(factor) > 1e10) << factor;
    }
    EXPECT_GT(undefined, 10);
    EXPECT_LT(undefined, static_cast<int>(colour.total.size()));
    EXPECT_GT(colour.xyz[1], 0.0);
}
