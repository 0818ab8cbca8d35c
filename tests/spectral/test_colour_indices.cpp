#include "host/spectral/colour/colour_indices.h"

#include "host/spectral/colour/colour_report.h"
#include "host/spectral/colour/lamp.h"
#include "host/spectral/text/number_table.h"
#include "reradiant/paths.h"
#include "reradiant/spectral_files.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

using namespace reradiant;

namespace {

ReradiationMatrix shipped(const std::string& name) {
    return read_reradiation(std::filesystem::path(RERADIANT_SOURCE_DIR) / "spectra" /
                            "reradiation" / name);
}

/// White paper with a brightener that 300 to 400 nm excite, in bands of 10 nm.
ReradiationMatrix brightened_paper(double brightener) {
    ReradiationMatrix paper;
    paper.emission = paper.excitation = {300.0, 10.0, 49};
    paper.values.setZero(49, 49);
    for (int band = 0; band < 49; ++band)
        paper.values(band, band) = 0.86;
    for (int excitation = 0; excitation < 10; ++excitation)
        for (int emission = 12; emission < 18; ++emission)
            paper.values(emission, excitation) = brightener / 6.0;
    return paper;
}

std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> result;
    std::istringstream parts(line + ',');
    for (std::string cell; std::getline(parts, cell, ',');)
        result.push_back(cell);
    return result;
}

void expect_row(const std::vector<std::string>& row) {
    const Observer observer = observer_named(row[2]);
    const MatrixColour colour = colour_of_matrix(shipped(row[0]), lamp_from_text(row[1]).light,
                                                 ColourSum::Bands, {.observer = observer});
    const std::string what = row[0] + " " + row[1] + " " + row[2];
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(colour.xyz[c], std::stod(row[3 + c]), 1e-6) << what;
        EXPECT_NEAR(colour.lab[c], std::stod(row[6 + c]), 1e-6) << what;
    }
    const auto e313 = astm_e313(colour.xyz, row[1], observer);
    ASSERT_EQ(e313.has_value(), !row[9].empty()) << what;
    if (!e313)
        return;
    const Whiteness white = cie_whiteness(colour.xyz, colour.white, observer);
    EXPECT_NEAR(white.whiteness, std::stod(row[9]), 1e-5) << what;
    EXPECT_NEAR(white.tint, std::stod(row[10]), 1e-5) << what;
    EXPECT_NEAR(e313->whiteness, std::stod(row[11]), 1e-5) << what;
    EXPECT_NEAR(e313->yellowness, std::stod(row[12]), 1e-5) << what;
}

} // namespace

// The file has nine digits; both sides sum the same tables, in another order.
TEST(ColourIndices, AgreeWithColourScienceForLampsAndObservers) {
    std::ifstream file(std::filesystem::path(RERADIANT_SOURCE_DIR) /
                       "tests/spectral/inputs/colour-science.csv");
    int rows = 0;
    for (std::string line; std::getline(file, line);)
        if (!line.starts_with('#') && !line.starts_with("matrix,")) {
            expect_row(cells(line));
            ++rows;
        }
    EXPECT_EQ(rows, 6 * 6 * 4);
}

// Sums of the tables of colour-science 0.4.7, which are the CIE's.
TEST(ColourIndices, ObserversAreTheTablesOfTheCie) {
    struct Sums {
        const char* name;
        std::array<double, 3> sums;
        double from_nm;
    };
    for (const Sums& expected : {Sums{"1964-10", {116.64851951, 116.6618771, 116.67398051}, 360.0},
                                 {"2015-2", {113.04231843, 113.04231457, 113.04231489}, 390.0},
                                 {"2015-10", {118.518091, 118.51809153, 118.5180953}, 390.0}}) {
        const ColourMatching& eye = colour_matching(observer_named(expected.name));
        EXPECT_EQ(eye.wavelengths_nm.front(), expected.from_nm);
        EXPECT_EQ(eye.wavelengths_nm.back(), 830.0);
        std::array<double, 3> sums{};
        for (std::size_t k = 0; k < eye.x.size(); ++k) {
            sums[0] += eye.x[k];
            sums[1] += eye.y[k];
            sums[2] += eye.z[k];
        }
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(sums[c], expected.sums[c], 1e-7) << expected.name;
    }
    EXPECT_EQ(observer_name(observer_named("1931-2")), "1931-2");
    EXPECT_THROW(observer_named("1931"), std::invalid_argument);
}

// colour-science 0.4.7: delta_E of CIE 1976, CIE 1994, CIE 2000, and CMC with l = 2, c = 1.
TEST(ColourIndices, DifferencesAgreeWithColourScience) {
    struct Pair {
        std::array<double, 3> reference, sample;
        double cie1976, cie1994, ciede2000, cmc21;
    };
    for (const Pair& pair :
         {Pair{{100, 21.57210357, 272.2281935},
               {100, 426.67945353, 72.39590835},
               451.713301974,
               83.779225501,
               94.035649027,
               172.704771287},
          {{50, 2.5, 0}, {61, -5, 29}, 31.910029771, 29.441373278, 22.897692470, 38.475767235},
          {{14, -3, 8}, {17, 1, -2}, 11.180339887, 9.467689632, 10.582881185, 12.291652046},
          {{72, 40, -31}, {70, 45, -20}, 12.247448714, 7.124253793, 6.403781442, 6.817404728},
          {{80, -60, -20}, {83, -50, -35}, 18.275666882, 9.676116292, 8.904878735, 8.398240861}}) {
        const ColourDifferences seen = colour_differences(pair.reference, pair.sample);
        EXPECT_NEAR(seen.cie1976, pair.cie1976, 1e-8);
        EXPECT_NEAR(seen.cie1994, pair.cie1994, 1e-8);
        EXPECT_NEAR(seen.ciede2000, pair.ciede2000, 1e-8);
        EXPECT_NEAR(seen.cmc21, pair.cmc21, 1e-8);
    }
    EXPECT_EQ(colour_differences({50, 0, 0}, {50, 0, 0}).cmc21, 0.0);
}

TEST(ColourIndices, HueIsInDegrees) {
    EXPECT_NEAR(lab_to_lch({50, 0, 10})[2], 90.0, 1e-12);
    EXPECT_NEAR(lab_to_lch({50, 3, -4})[1], 5.0, 1e-12);
    EXPECT_NEAR(lab_to_lch({50, 0, -10})[2], 270.0, 1e-12);
    EXPECT_EQ(lab_to_lch({50, 0, 0})[2], 0.0);
}

// What the standard says of its weights in words: an effective wavelength of 457 nm and a half
// bandwidth of 44 nm.
TEST(ColourIndices, WeightsOfBrightnessAreThoseOfTheStandardsWords) {
    const NumberTable table = read_number_table(spectra_directory() / "brightness" / "r457.csv", 2);
    const Spectrum weights = Spectrum::table(table.columns[0], table.columns[1]);
    double sum = 0.0, moment = 0.0, half_width = 0.0;
    for (double nm = 400.0; nm <= 510.0; nm += 0.01) {
        sum += weights(nm);
        moment += nm * weights(nm);
        half_width += weights(nm) >= 50.0 ? 0.01 : 0.0;
    }
    EXPECT_NEAR(moment / sum, 457.0, 0.5);
    EXPECT_NEAR(half_width, 44.0, 0.5);
}

TEST(ColourIndices, AFlatWhiteIsWhiteUnderAnyLampForAnyObserver) {
    const ReradiationMatrix grey = brightened_paper(0.0);
    for (const char* lamp : {"D65", "C", "FL11", "P:2700", "D65+20*L:435.8", "M0", "M1", "M2"})
        for (const char* eye : {"1931-2", "1964-10", "2015-2", "2015-10"}) {
            const Lamp light = lamp_from_text(lamp);
            const MatrixColour colour = colour_of_matrix(
                grey, light.light, ColourSum::Automatic,
                {.observer = observer_named(eye), .weighted_by = light.weighted_by});
            EXPECT_NEAR(colour.xyz[1], 86.0, 1e-9) << lamp << ' ' << eye;
            EXPECT_NEAR(colour.lab[1], 0.0, 1e-9) << lamp << ' ' << eye;
            EXPECT_NEAR(colour.lab[2], 0.0, 1e-9) << lamp << ' ' << eye;
            EXPECT_NEAR(r457(colour).value_or(86.0), 86.0, 1e-9) << lamp;
        }
}

TEST(ColourIndices, APerfectWhiteIsLab100UnderAnyLampForAnyObserver) {
    ReradiationMatrix white = brightened_paper(0.0);
    white.values.setIdentity(49, 49);
    for (const char* lamp : {"A", "D65", "C", "E", "FL2", "FL11", "HP1", "LED-V2", "ID65", "P:2000",
                             "D:25000", "L:550", "D65+20*L:365", "M0", "M1", "M2"})
        for (const char* eye : {"1931-2", "1964-10", "2015-2", "2015-10"})
            for (const ColourSum sum : {ColourSum::Automatic, ColourSum::Bands, ColourSum::E308}) {
                const ColourReport report =
                    colour_report(white, lamp_from_text(lamp), sum, observer_named(eye));
                EXPECT_NEAR(report.colour.lab[0], 100.0, 1e-9) << lamp << ' ' << eye;
                EXPECT_NEAR(report.colour.lab[1], 0.0, 1e-9) << lamp << ' ' << eye;
                EXPECT_NEAR(report.colour.lab[2], 0.0, 1e-9) << lamp << ' ' << eye;
                // The perfect diffuser has whiteness 100 and tint 0 by definition.
                if (report.whiteness) {
                    EXPECT_NEAR(report.whiteness->whiteness, 100.0, 1e-9);
                    EXPECT_NEAR(report.whiteness->tint, 0.0, 1e-9);
                }
                // The coefficients of E313 make its yellowness 0 for whites of 5 nm sums; those of
                // 10 nm sums have 0.1 % more or less of Z.
                if (report.e313) {
                    EXPECT_NEAR(report.e313->yellowness, 0.0, 0.15) << lamp << ' ' << eye;
                }
            }
}

// CIE 15, 9.1: W is Y + 800 (xn - x) + 1700 (yn - y), tint 1000 (900 for 10 degrees) (xn - x) - 650
// (yn - y). By hand for a bluish white of x = 0.3027, y = 0.3190, Y = 92 under xn = 0.3127, yn =
// 0.3290: 92 + 8 + 17 = 117, and 10 - 6.5 = 3.5 or 9 - 6.5 = 2.5.
TEST(ColourIndices, WhitenessByHand) {
    const auto xyz = [](double x, double y, double luminance) {
        return Xyz{x / y * luminance, luminance, (1.0 - x - y) / y * luminance};
    };
    const Xyz white = xyz(0.3127, 0.3290, 100.0), bluish = xyz(0.3027, 0.3190, 92.0);
    const Whiteness of_2 = cie_whiteness(bluish, white, Observer::Cie1931Deg2),
                    of_10 = cie_whiteness(bluish, white, Observer::Cie1964Deg10);
    EXPECT_NEAR(of_2.whiteness, 117.0, 1e-9);
    EXPECT_NEAR(of_10.whiteness, 117.0, 1e-9);
    EXPECT_NEAR(of_2.tint, 3.5, 1e-9);
    EXPECT_NEAR(of_10.tint, 2.5, 1e-9);
    EXPECT_FALSE(of_2.within_limits) << "a tint of 2 is the limit";
}

// Without what ultraviolet light excites the paper is its grey, and so it is under a lamp that has
// none.
TEST(ColourIndices, BrightenerIsWhatUltravioletLightAdds) {
    const ReradiationMatrix paper = brightened_paper(0.4);
    const Spectrum d65 = illuminant("D65");
    const MatrixColour seen = colour_of_matrix(paper, d65, ColourSum::Bands);
    const MatrixColour without =
        colour_of_matrix(paper, d65, ColourSum::Bands, {.excites_from_nm = 420.0});
    EXPECT_GT(cie_whiteness(seen.xyz, seen.white).whiteness,
              cie_whiteness(without.xyz, without.white).whiteness + 10.0);
    EXPECT_GT(*r457(seen), *r457(without) + 5.0);
    EXPECT_NEAR(without.lab[2], 0.0, 1e-9);
    EXPECT_NEAR(without.xyz[1], 86.0, 1e-9);
    const MatrixColour cut = colour_of_matrix(
        paper, without_ultraviolet(lamp_from_text("D65"), 420).light, ColourSum::Bands);
    EXPECT_NEAR(cut.lab[2], 0.0, 1e-9);
}

// By hand: under A light of 300 to 390 nm excites b/6 per band in six bands; the radiance factor
// there, times D50, is what counts.
TEST(ColourIndices, RadianceFactorsUnderOneLampAreWeightedByAnother) {
    const ReradiationMatrix paper = brightened_paper(0.4);
    const Lamp lamp = lamp_from_text("M0");
    const Spectrum a = illuminant("A"), d50 = illuminant("D50");
    const MatrixColour seen =
        colour_of_matrix(paper, lamp.light, ColourSum::Bands, {.weighted_by = lamp.weighted_by});
    double excited = 0.0, y = 0.0, white = 0.0;
    for (double nm = 300; nm < 400; nm += 10)
        excited += a(nm) * 0.4 / 6.0;
    const ColourMatching& eye = cie_1931_2_degree();
    for (std::size_t k = 0; k < eye.y.size(); k += 10) {
        const double nm = eye.wavelengths_nm[k];
        if (nm > 780)
            break;
        const double factor = 0.86 + (nm >= 420 && nm < 480 ? excited / a(nm) : 0.0);
        y += factor * d50(nm) * eye.y[k];
        white += d50(nm) * eye.y[k];
    }
    EXPECT_NEAR(seen.xyz[1], 100.0 * y / white, 1e-9);
}

TEST(ColourIndices, BrightnessNeedsItsBands) {
    ReradiationMatrix narrow;
    narrow.emission = narrow.excitation = {410.0, 10.0, 30};
    narrow.values.setIdentity(30, 30);
    EXPECT_FALSE(r457(colour_of_matrix(narrow, illuminant("D65"), ColourSum::Bands)).has_value());
}

// Samples that match under both lamps have none, and so have those that differ by one factor.
TEST(ColourIndices, MetamerismIsWhatTheLampChanges) {
    ReradiationMatrix grey = brightened_paper(0.0), dark = grey;
    dark.values *= 0.9;
    const auto under = [](const ReradiationMatrix& matrix, const char* lamp) {
        return colour_of_matrix(matrix, illuminant(lamp), ColourSum::Bands);
    };
    EXPECT_NEAR(metamerism_index(under(grey, "D65"), under(dark, "D65"), under(grey, "A"),
                                 under(dark, "A")),
                0.0, 1e-9);
    const ReradiationMatrix paper = brightened_paper(0.4);
    EXPECT_GT(metamerism_index(under(grey, "D65"), under(paper, "D65"), under(grey, "A"),
                               under(paper, "A")),
              1.0);
}
