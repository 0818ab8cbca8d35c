#include "reradiant/colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using namespace reradiant;

namespace {

std::array<double, 2> chromaticity(const Xyz& xyz) {
    const double sum = xyz[0] + xyz[1] + xyz[2];
    return {xyz[0] / sum, xyz[1] / sum};
}

} // namespace

TEST(Colour, ObserverIsTheTableOfTheCie) {
    const ColourMatching& eye = cie_1931_2_degree();
    ASSERT_EQ(eye.wavelengths_nm.size(), 471u);
    EXPECT_EQ(eye.wavelengths_nm.front(), 360.0);
    EXPECT_EQ(eye.wavelengths_nm.back(), 830.0);
    EXPECT_EQ(eye.y[555 - 360], 1.0);
    // Sums of the 1 nm table as published by the CIE (five digits).
    double x = 0, y = 0, z = 0;
    for (std::size_t k = 0; k < eye.x.size(); ++k) {
        x += eye.x[k];
        y += eye.y[k];
        z += eye.z[k];
    }
    EXPECT_NEAR(x, 106.8655, 1e-4);
    EXPECT_NEAR(y, 106.8569, 1e-4);
    EXPECT_NEAR(z, 106.8923, 1e-4);
}

TEST(Colour, WhitePointsAgreeWithTheCie) {
    // CIE 15:2018, tables of chromaticities, four decimals (five for A and D65); the CIE sums at
    // 5 nm what is integrated here (C is printed with the rounding of 1931).
    struct White {
        const char* name;
        double x, y, tolerance;
    };
    for (const White& white : {White{"A", 0.44758, 0.40745, 2e-5},
                               {"C", 0.31006, 0.31616, 1e-4},
                               {"D50", 0.34567, 0.35851, 3e-5},
                               {"D55", 0.33243, 0.34744, 3e-5},
                               {"D65", 0.31272, 0.32903, 2e-5},
                               {"D75", 0.29903, 0.31488, 3e-5},
                               {"E", 0.33331, 0.33329, 3e-5},
                               {"FL2", 0.3721, 0.3751, 3e-3},
                               {"FL11", 0.3805, 0.3769, 3e-3},
                               {"HP1", 0.533, 0.415, 3e-3},
                               {"LED-B3", 0.3756, 0.3723, 1e-3}}) {
        const auto xy = chromaticity(xyz_of(illuminant(white.name)));
        EXPECT_NEAR(xy[0], white.x, white.tolerance) << white.name;
        EXPECT_NEAR(xy[1], white.y, white.tolerance) << white.name;
    }
}

TEST(Colour, IlluminantsAre100At560Nm) {
    EXPECT_NEAR(illuminant("A")(560), 100.0, 1e-9);
    EXPECT_NEAR(illuminant("D65")(560), 100.0, 1e-9);
    EXPECT_NEAR(illuminant("D50")(560), 100.0, 1e-9);
    EXPECT_NEAR(illuminant("D65")(300), 0.0341, 1e-9);
}

TEST(Colour, UnknownIlluminantIsRefusedWithTheList) {
    try {
        illuminant("D99");
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("D65"), std::string::npos);
    }
    EXPECT_THROW(illuminant("../observers/cie-1931-2-degree"), std::invalid_argument);
    EXPECT_THROW(illuminant(""), std::invalid_argument);
}

TEST(Colour, LampTablesAreDarkOutsideTheirData) {
    const Spectrum lamp = illuminant("FL11");
    EXPECT_GT(lamp(380), 0.0);
    EXPECT_EQ(lamp(379), 0.0);
    EXPECT_EQ(lamp(781), 0.0);
    EXPECT_TRUE(lamp.is_zero_within(300, 379));
    EXPECT_NEAR(lamp.data_from_nm(), 380.0, 1e-5);
    EXPECT_NEAR(illuminant("D65").data_from_nm(), 300.0, 1e-5);
}

TEST(Colour, UnitRadianceHasUnitLuminance) {
    // Rounding only: the same table is integrated twice.
    EXPECT_NEAR(xyz_of(Spectrum::constant(1.0))[1], 1.0, 1e-13);
    for (const double step : {1.0, 5.0, 10.0}) {
        double y = 0.0;
        for (const Xyz& weight : xyz_weights({355.0, step, static_cast<int>(480.0 / step) + 1}))
            y += weight[1];
        EXPECT_NEAR(y, 1.0, 1e-12) << step;
    }
}

TEST(Colour, BoxesAreExact) {
    // A box over one cell of a grid weighs as that cell does.
    const WavelengthGrid grid{550.0, 10.0, 1};
    const Xyz box = xyz_of(Spectrum::line(550.0, 10.0, 10.0)), cell = xyz_weights(grid)[0];
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(box[c], cell[c], 1e-15);
    EXPECT_EQ(xyz_of(Spectrum::line(340, 10, 1))[1], 0.0);
}

TEST(Colour, IlluminantWithLuminanceHasThatLuminance) {
    for (const char* name : {"D65", "A", "E", "FL11", "HP1", "LED-V2"})
        EXPECT_NEAR(xyz_of(illuminant_with_luminance(name, 12.0))[1], 12.0, 1e-11) << name;
}

TEST(Colour, LabOfWhiteAndOfADarkGrey) {
    const Xyz white{0.9505, 1.0, 1.0888};
    const auto lab = xyz_to_lab(white, white);
    EXPECT_NEAR(lab[0], 100.0, 1e-12);
    EXPECT_NEAR(lab[1], 0.0, 1e-12);
    // Below 216/24389 the function is linear: L = 24389/27 Y.
    EXPECT_NEAR(xyz_to_lab({0.001 * 0.9505, 0.001, 0.001 * 1.0888}, white)[0], 24.389 / 27.0,
                1e-12);
}

TEST(Colour, Ciede2000AgreesWithThePublishedPairs) {
    // Sharma, Wu and Dalal 2005, table 1, printed with four decimals.
    struct Pair {
        std::array<double, 3> a, b;
        double difference;
    };
    for (const Pair& pair : {Pair{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
                             {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
                             {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
                             {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
                             {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
                             {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
                             {{50, 0, 0}, {50, -1, 2}, 2.3669},
                             {{50, 2.49, -0.001}, {50, -2.49, 0.0009}, 7.1792},
                             {{50, 2.49, -0.001}, {50, -2.49, 0.0010}, 7.1792},
                             {{50, 2.49, -0.001}, {50, -2.49, 0.0011}, 7.2195},
                             {{50, 2.49, -0.001}, {50, -2.49, 0.0012}, 7.2195},
                             {{50, -0.001, 2.49}, {50, 0.0009, -2.49}, 4.8045},
                             {{50, -0.001, 2.49}, {50, 0.0010, -2.49}, 4.8045},
                             {{50, -0.001, 2.49}, {50, 0.0011, -2.49}, 4.7461},
                             {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
                             {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
                             {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
                             {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
                             {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
                             {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
                             {{50, 2.5, 0}, {50, 3.2972, 0}, 1.0000},
                             {{50, 2.5, 0}, {50, 1.8634, 0.5757}, 1.0000},
                             {{50, 2.5, 0}, {50, 3.2592, 0.3350}, 1.0000},
                             {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
                             {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
                             {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
                             {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
                             {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
                             {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
                             {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
                             {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
                             {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
                             {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}}) {
        EXPECT_NEAR(ciede2000(pair.a, pair.b), pair.difference, 5e-5);
        EXPECT_NEAR(ciede2000(pair.b, pair.a), pair.difference, 5e-5);
    }
    EXPECT_EQ(ciede2000({50, 10, 10}, {50, 10, 10}), 0.0);
}

TEST(Colour, LinearSrgbMatrixIsThePublishedOne) {
    // IEC 61966-2-1 prints four decimals.
    const Xyz red = linear_srgb_to_xyz({1, 0, 0});
    EXPECT_NEAR(red[0], 0.4124, 5e-5);
    EXPECT_NEAR(red[1], 0.2126, 5e-5);
    EXPECT_NEAR(red[2], 0.0193, 5e-5);
    const auto back = xyz_to_linear_srgb(linear_srgb_to_xyz({0.2, 0.5, 0.9}));
    EXPECT_NEAR(back[0], 0.2, 1e-14);
    EXPECT_NEAR(back[2], 0.9, 1e-14);
}

TEST(Colour, AdaptingMovesWhiteToWhite) {
    const Xyz a = xyz_of(illuminant_with_luminance("A", 1.0));
    const Xyz d65 = xyz_of(illuminant_with_luminance("D65", 1.0));
    const Xyz adapted = adapt_white(a, a, d65);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(adapted[c], d65[c], 1e-12);
}

TEST(Colour, ReflectanceFromRgbRoundTripsUnderD65) {
    const Spectrum d65 = illuminant_with_luminance("D65", 1.0);
    const ColourMatching& eye = cie_1931_2_degree();
    for (int k = 0; k < 125; ++k) {
        const int red = k % 5, green = k / 5 % 5, blue = k / 25;
        const std::array<double, 3> rgb = {0.25 * red, 0.25 * green, 0.25 * blue};
        const Spectrum reflectance = reflectance_from_rgb(rgb);
        EXPECT_GE(reflectance.minimum(300, 900), 0.0);
        EXPECT_LE(reflectance.maximum(300, 900), 1.0);
        Xyz xyz{};
        for (std::size_t n = 0; n < eye.y.size(); ++n) {
            const double light = d65(eye.wavelengths_nm[n]) * reflectance(eye.wavelengths_nm[n]);
            xyz[0] += light * eye.x[n] / 106.8569171;
            xyz[1] += light * eye.y[n] / 106.8569171;
            xyz[2] += light * eye.z[n] / 106.8569171;
        }
        const auto back = xyz_to_linear_srgb(xyz);
        // 2.5e-4 of it is the difference between the whites of sRGB and of the D65 table.
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(back[c], rgb[c], 1e-3) << rgb[0] << " " << rgb[1] << " " << rgb[2];
    }
}

TEST(Colour, GreyRgbIsSpectrallyFlat) {
    for (const double grey : {0.0, 0.18, 1.0}) {
        EXPECT_TRUE(reflectance_from_rgb({grey, grey, grey}).is_constant());
        EXPECT_EQ(reflectance_from_rgb({grey, grey, grey})(555), grey);
    }
    EXPECT_THROW(reflectance_from_rgb({1.1, 0, 0}), std::invalid_argument);
    EXPECT_THROW(reflectance_from_rgb({-0.1, 0, 0}), std::invalid_argument);
    EXPECT_THROW(reflectance_from_rgb({std::nan(""), 0, 0}), std::invalid_argument);
}
