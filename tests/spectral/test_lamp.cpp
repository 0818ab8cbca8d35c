#include "host/spectral/colour/lamp.h"

#include "reradiant/colour.h"
#include "reradiant/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

using namespace reradiant;

namespace {

std::filesystem::path scratch(const std::string& name, const std::string& text) {
    const std::filesystem::path file = std::filesystem::temp_directory_path() / name;
    std::ofstream(file) << text;
    return file;
}

std::string refusal(const std::string& text) {
    try {
        lamp_from_text(text);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

} // namespace

// colour-science 0.4.7: sd_CIE_illuminant_D_series at CCT_to_xy_CIE_D of the temperature, relative
// to 560 nm. Both round M1 and M2 to three decimals, so only rounding of the last digit differs.
TEST(Lamp, DaylightAgreesWithColourScience) {
    struct Daylight {
        double kelvin;
        std::array<double, 5> power; ///< at 320, 400, 450, 650, 780 nm
    };
    const std::array<double, 5> nm = {320, 400, 450, 650, 780};
    for (const Daylight& day : {Daylight{5000, {0.07772, 0.492603, 0.871997, 0.957071, 0.783116}},
                                {5500, {0.112136, 0.609021, 0.979481, 0.888867, 0.718484}},
                                {6504, {0.202584, 0.827983, 1.170435, 0.800161, 0.633724}},
                                {8000, {0.343808, 1.104348, 1.399658, 0.729846, 0.565472}}}) {
        const Spectrum lamp = cie_daylight(day.kelvin);
        for (std::size_t k = 0; k < nm.size(); ++k)
            EXPECT_NEAR(lamp(nm[k]) / lamp(560), day.power[k], 1e-9) << day.kelvin << ' ' << nm[k];
        EXPECT_NEAR(xyz_of(lamp)[1], 1.0, 1e-12);
        EXPECT_EQ(lamp(299), 0.0);
    }
    EXPECT_THROW(cie_daylight(3999), std::invalid_argument);
    EXPECT_THROW(cie_daylight(25001), std::invalid_argument);
}

TEST(Lamp, SumsAddWhatSceneFilesWouldAdd) {
    const Lamp lamp = lamp_from_text("2*D65+0.3*L:365:4+P:2856");
    EXPECT_NEAR(xyz_of(lamp.light.without_lines())[1], 3.0, 1e-12);
    ASSERT_EQ(lamp.light.lines().size(), 1u);
    EXPECT_EQ(lamp.light.lines()[0].centre_nm, 365.0);
    EXPECT_EQ(lamp.light.lines()[0].width_nm, 4.0);
    EXPECT_EQ(lamp.light.lines()[0].integral, 0.3);
    EXPECT_EQ(lamp_from_text("L:405").light.lines()[0].width_nm, 1.0);
    // A name alone is the CIE's table as it is.
    EXPECT_EQ(lamp_from_text("D65").light(560), 100.0);
}

TEST(Lamp, ConditionsOfIso13655AreWeightedByD50) {
    for (const char* name : {"M0", "M2"}) {
        const Lamp lamp = lamp_from_text(name);
        ASSERT_TRUE(lamp.weighted_by.has_value()) << name;
        EXPECT_EQ((*lamp.weighted_by)(500), illuminant("D50")(500)) << name;
        EXPECT_EQ(lamp.light(500), illuminant("A")(500)) << name;
    }
    EXPECT_GT(lamp_from_text("M0").light(390), 0.0);
    EXPECT_EQ(lamp_from_text("M2").light(399), 0.0);
    EXPECT_EQ(lamp_from_text("M1").light(390), illuminant("D50")(390));
}

TEST(Lamp, CutsAreExactForTablesAndLines) {
    Spectrum light = illuminant("D65");
    light += Spectrum::line(400, 10, 5);
    const Spectrum cut = cut_to(light, 398, 2000);
    EXPECT_EQ(cut(397.9), 0.0);
    EXPECT_NEAR(cut.average(398, 830), light.average(398, 830), 1e-12 * light.average(398, 830));
    EXPECT_NEAR(cut.lines()[0].integral, 5.0 * 7.0 / 10.0, 1e-12);
    // A black body becomes a table of 1 nm: trapezoids, whose error is of second order.
    const Spectrum body = Spectrum::blackbody(3200, 1.0);
    EXPECT_NEAR(cut_to(body, 420, 900).average(420, 800), body.average(420, 800), 1e-5);
    EXPECT_THROW(cut_to(body, 500, 400), std::invalid_argument);
    EXPECT_THROW(without_ultraviolet({"D65", light}, 100), std::invalid_argument);
    // Nothing lies below: the lamp stays as it is, and so do the warnings about its table.
    EXPECT_EQ(without_ultraviolet(lamp_from_text("FL2"), 300).cut_below_nm, 0.0);
}

// numpy's trapezoid of colour-science's D65, which ends at 780 nm, has 0.0950729; ours goes on to
// 830 nm, where its table ends in the CIE's.
TEST(Lamp, UltravioletShareOfD65) {
    const Spectrum d65 = illuminant("D65");
    const double to_780 = d65.average(300, 400) * 100 / (d65.average(300, 780) * 480);
    EXPECT_NEAR(ultraviolet_share(cut_to(d65, 300, 780)), to_780, 1e-8);
    EXPECT_NEAR(ultraviolet_share(d65), d65.average(300, 400) * 100 / (d65.average(300, 830) * 530),
                1e-14);
    EXPECT_EQ(ultraviolet_share(Spectrum::line(365, 1, 1)), 1.0);
    EXPECT_TRUE(std::isnan(ultraviolet_share(Spectrum::line(900, 1, 1))));
}

TEST(Lamp, BadLampsAreRefused) {
    for (const char* text : {"", "D66", "D65+", "+", "X*D65", "0*D65", "-1*D65", "D:3000", "D:",
                             "P:20", "L:50", "L:400:0", "L:400:1:2", "M0+D65", "2*M1", "D65:3"})
        EXPECT_FALSE(refusal(text).empty()) << text;
    EXPECT_NE(refusal("D66").find("FL11"), std::string::npos) << refusal("D66");
    EXPECT_NE(refusal("D66").find("L:NM"), std::string::npos) << refusal("D66");
    EXPECT_NE(refusal("D:3000").find("4000"), std::string::npos) << refusal("D:3000");
}

TEST(Lamp, FilesAreDarkOutsideTheirData) {
    const Lamp lamp = read_lamp(scratch("lamp.csv", "nm,value\n400,1\n700,3\n"));
    EXPECT_EQ(lamp.name, "lamp.csv");
    EXPECT_EQ(lamp.light(399), 0.0);
    EXPECT_DOUBLE_EQ(lamp.light(550), 2.0);
    EXPECT_EQ(lamp.light(701), 0.0);
    EXPECT_THROW(read_lamp(scratch("negative.csv", "nm,value\n400,1\n500,-1\n700,3\n")), Error);
    EXPECT_THROW(read_lamp(scratch("infrared.csv", "nm,value\n850,1\n900,3\n")), Error);
}

// Lab is relative to a white under the same lamp: where the eye sees almost none of that, it means
// little.
TEST(Lamp, LightThatTheEyeHardlySeesIsWarnedOf) {
    for (const char* text : {"L:365", "L:405", "L:760", "L:380:30"}) {
        const std::string warning =
            faint_white_warning(lamp_from_text(text), Observer::Cie1931Deg2);
        EXPECT_NE(warning.find(std::string("D65+30*") + text), std::string::npos)
            << text << ' ' << warning;
    }
    EXPECT_NE(faint_white_warning(lamp_from_text("L:365+L:370"), Observer::Cie1964Deg10)
                  .find("D65+30*L:365"),
              std::string::npos);
    for (const char* text : {"D65", "A", "E", "FL11", "LED-V1", "HP1", "P:1500", "D65+30*L:365",
                             "L:450", "L:700", "M0", "M2"})
        for (const Observer observer : {Observer::Cie1931Deg2, Observer::Cie2015Deg10})
            EXPECT_EQ(faint_white_warning(lamp_from_text(text), observer), "") << text;
}
