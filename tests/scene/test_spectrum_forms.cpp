#include "tests/scene/scratch.h"

#include "reradiant/colour.h"
#include "reradiant/scene_file.h"

#include <cmath>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

class SpectrumForms : public Scratch {
protected:
    /// The environment's radiance written as `text`.
    Spectrum read(const std::string& text) {
        const auto file =
            write("scene.toml", replaced(SMALL_SCENE, "radiance = 1", "radiance = " + text));
        return light_spectrum(load_scene(file).lights[0]);
    }
    /// Column where reading it fails; the line is that of the key.
    int error_column(const std::string& text, const std::string& message) {
        const Caught error = error_of([&] { read(text); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_EQ(error.line, 9) << error.text;
        EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
        return error.column;
    }
};

} // namespace

TEST_F(SpectrumForms, ANumberIsConstant) {
    EXPECT_TRUE(read("2.5").is_constant());
    EXPECT_EQ(read("2.5")(123.0), 2.5);
    EXPECT_EQ(read("3")(600.0), 3.0);
}

TEST_F(SpectrumForms, ATableIsLinearBetweenAndConstantOutside) {
    const Spectrum s = read("{ nm = [400, 500], value = [1, 3] }");
    EXPECT_NEAR(s(450.0), 2.0, 1e-14);
    EXPECT_EQ(s(300.0), 1.0);
    EXPECT_EQ(s(800.0), 3.0);
}

TEST_F(SpectrumForms, Case35ASinglePointIsAConstant) {
    EXPECT_EQ(read("{ nm = [500], value = [2] }")(700.0), 2.0);
}

TEST_F(SpectrumForms, IlluminantAndBlackbodyHaveTheLuminanceOfTheirScale) {
    // Tables are summed at 1 nm: exact to rounding; the blackbody is integrated to 1e-10.
    EXPECT_NEAR(xyz_of(read("{ illuminant = \"D65\", scale = 12 }"))[1], 12.0, 1e-9);
    EXPECT_NEAR(xyz_of(read("{ illuminant = \"A\" }"))[1], 1.0, 1e-9);
    const Spectrum body = read("{ blackbody_kelvin = 2856, scale = 5 }");
    EXPECT_NEAR(xyz_of(body)[1], 5.0, 1e-6);
    EXPECT_GT(body(700.0), body(450.0));
}

TEST_F(SpectrumForms, ALineIsABoxWithTheIntegralOfItsScale) {
    const Spectrum s = read("{ line_nm = 405, width_nm = 10, scale = 3 }");
    ASSERT_EQ(s.lines().size(), 1u);
    EXPECT_EQ(s.lines()[0].centre_nm, 405.0);
    EXPECT_EQ(s.lines()[0].width_nm, 10.0);
    EXPECT_EQ(s.lines()[0].integral, 3.0);
}

TEST_F(SpectrumForms, AGaussianHasThePeakOfItsScale) {
    const Spectrum s = read("{ gaussian_nm = 520, sigma_nm = 20, scale = 4 }");
    EXPECT_NEAR(s(520.0), 4.0, 1e-14);
    EXPECT_NEAR(s(540.0), 4.0 * std::exp(-0.5), 1e-13);
}

TEST_F(SpectrumForms, AListIsASum) {
    const Spectrum s =
        read("[1, { gaussian_nm = 520, sigma_nm = 20 }, [2, { line_nm = 405, width_nm = 2 }]]");
    EXPECT_NEAR(s(520.0), 4.0, 1e-13);
    EXPECT_EQ(s.lines().size(), 1u);
}

TEST_F(SpectrumForms, AProductIsALampBehindItsFilters) {
    const Spectrum s = read("{ product = [{ illuminant = \"A\" }, { nm = [500, 600], value = [0, "
                            "1] }, 0.5], scale = 4 }");
    const Spectrum lamp = read("{ illuminant = \"A\" }");
    // tables are linear between 1 nm: their product is off by an eighth of its curvature at most
    EXPECT_NEAR(s(540.5), 4.0 * 0.5 * 0.405 * lamp(540.5), 1e-4);
    EXPECT_EQ(s(480.0), 0.0);
    // lines stay lines, as high as the filter lets them
    const Spectrum line = read("{ product = [[{ line_nm = 550, width_nm = 2, scale = 3 }, 1], "
                               "{ nm = [500, 600], value = [0, 1] }] }");
    ASSERT_EQ(line.lines().size(), 1u);
    EXPECT_NEAR(line.lines()[0].integral, 1.5, 1e-12);
    EXPECT_NEAR(line(575.0), 0.75, 1e-12);
    const Spectrum both = read("{ product = [{ line_nm = 550, width_nm = 4, scale = 8 }, "
                               "{ line_nm = 551, width_nm = 4, scale = 4 }] }");
    ASSERT_EQ(both.lines().size(), 1u);
    EXPECT_NEAR(both.lines()[0].width_nm, 3.0, 1e-12);
    EXPECT_NEAR(both.lines()[0].integral, 2.0 * 1.0 * 3.0, 1e-12);
}

TEST_F(SpectrumForms, AFilterAboveOneIsWarnedAbout) {
    const auto warned = warnings_of([&] {
        read("{ product = [5, { gaussian_nm = 500, sigma_nm = "
             "20, scale = 1.5 }] }");
    });
    ASSERT_EQ(warned.size(), 1u);
    EXPECT_NE(warned[0].find("scene.toml:9:14: product[1] goes up to 1.5"), std::string::npos)
        << warned[0];
    EXPECT_TRUE(warnings_of([&] { read("{ product = [5, 1.0] }"); }).empty());
}

TEST_F(SpectrumForms, ASumHasAScaleAndValuesAreCutAfterIt) {
    const Spectrum s = read("{ sum = [1, { gaussian_nm = 520, sigma_nm = 20 }], scale = 2, min = "
                            "2.5, max = 3 }");
    EXPECT_EQ(s(520.0), 3.0);
    EXPECT_EQ(s(700.0), 2.5);
    EXPECT_NEAR(s(540.0), 3.0, 1e-12); // 2 + 2 exp(-1/2) is above
    write("noisy.csv", "nm,value\n400,-0.1\n500,1\n");
    EXPECT_EQ(read("{ file = \"noisy.csv\", min = 0 }")(400.0), 0.0);
    EXPECT_EQ(error_column("{ sum = [1], min = 2, max = 1 }", "max is 1 and min 2"), 34);
    EXPECT_EQ(error_column("{ product = [] }", "a product of 0 spectra"), 14);
    EXPECT_EQ(error_column("{ product = 2 }", "product is"), 14);
    EXPECT_EQ(error_column("{ product = [1, { nm = [400, 390], value = [1, 1] }] }", "nm[1]"), 41);
}

TEST_F(SpectrumForms, RgbBecomesAReflectance) {
    const Spectrum s = read("{ rgb = [0.8, 0.3, 0.1] }");
    EXPECT_GE(s.minimum(380.0, 780.0), 0.0);
    EXPECT_LE(s.maximum(380.0, 780.0), 1.0);
    EXPECT_GT(s(650.0), s(450.0));
}

TEST_F(SpectrumForms, FilesAreReadBesideTheScene) {
    write("s.spd", "400 1\n500 3\n");
    write("s.csv", "nm,value\n400,1\n500,3\n");
    EXPECT_NEAR(read("{ file = \"s.spd\" }")(450.0), 2.0, 1e-14);
    EXPECT_NEAR(read("{ file = \"s.csv\" }")(450.0), 2.0, 1e-14);
}

TEST_F(SpectrumForms, ScaleMultipliesWhatHasValuesOfItsOwn) {
    write("s.csv", "nm,value\n400,1\n500,3\n");
    write("lamp.spd", "400 10\n700 30\n");
    EXPECT_NEAR(read("{ file = \"s.csv\", scale = 2 }")(450.0), 4.0, 1e-14);
    // A lamp's file is no exception: no luminance takes the place of its values.
    EXPECT_NEAR(read("{ file = \"lamp.spd\", scale = 0.5 }")(550.0), 10.0, 1e-13);
    EXPECT_NEAR(read("{ nm = [400, 500], value = [1, 3], scale = 2 }")(450.0), 4.0, 1e-14);
    const double once = read("{ rgb = [0.4, 0.3, 0.1] }")(650.0);
    EXPECT_NEAR(read("{ rgb = [0.4, 0.3, 0.1], scale = 1.5 }")(650.0), 1.5 * once, 1e-14);
    EXPECT_EQ(read("{ file = \"s.csv\", scale = 0 }")(450.0), 0.0);
    EXPECT_EQ(error_column("{ file = \"s.csv\", scale = -1 }", "at least 0"), 30);
    EXPECT_EQ(error_column("{ file = \"s.csv\", width_nm = 2 }", "unknown key"), 30);
}

TEST_F(SpectrumForms, WavelengthsOfAnotherUnitAreRefusedAtTheirKey) {
    EXPECT_EQ(error_column("{ nm = [4000, 7000], value = [0, 1] }", "cannot be in nm"), 14);
    EXPECT_EQ(error_column("{ nm = [1, 10], value = [0, 1] }", "cannot be in nm"), 14);
    const auto spectrum = write("s.csv", "0.4,0.1\n0.7,0.2\n");
    const Caught error = error_of([&] { read("{ file = \"s.csv\" }"); });
    EXPECT_EQ(error.file, spectrum.string());
    EXPECT_NE(error.text.find("micrometres"), std::string::npos) << error.text;
}

TEST_F(SpectrumForms, PeaksOfAnotherUnitAreRefusedAtTheirKey) {
    EXPECT_EQ(error_column("{ line_nm = 4050 }", "cannot be in nm"), 14);
    EXPECT_EQ(error_column("{ gaussian_nm = 5200, sigma_nm = 20 }", "cannot be in nm"), 14);
    EXPECT_EQ(error_column("[{ line_nm = 546 }, { line_nm = 40.5 }]", "cannot be in nm"), 34);
    EXPECT_EQ(read("[{ line_nm = 546 }, { line_nm = 1014 }]")(546.0), 1.0);
    // The flanks of peaks beyond 1000 nm are seen.
    EXPECT_GT(read("{ gaussian_nm = 1100, sigma_nm = 50 }")(1000.0), 0.0);
    EXPECT_GT(read("{ line_nm = 1010, width_nm = 40 }")(995.0), 0.0);
}

TEST_F(SpectrumForms, AnErrorWithinASpectrumFileIsPlacedThere) {
    const auto spectrum = write("s.spd", "400 1\n500 x\n");
    const Caught error = error_of([&] { read("{ file = \"s.spd\" }"); });
    EXPECT_EQ(error.file, spectrum.string());
    EXPECT_EQ(error.line, 2);
    EXPECT_EQ(error.exit_code, 2);
}

TEST_F(SpectrumForms, Case35BadTablesAreRefusedAtTheOffendingEntry) {
    // radiance = { nm = [400, 400], ...: the table starts in column 12, nm in 14, its array in 19.
    EXPECT_EQ(error_column("{ nm = [400, 400], value = [1, 1] }", "nm[1] = 400"), 25);
    EXPECT_EQ(error_column("{ nm = [400, 390], value = [1, 1] }", "nm[1] = 390"), 25);
    EXPECT_EQ(error_column("{ nm = [400, nan], value = [1, 1] }", "nm[1] is nan"), 25);
    EXPECT_EQ(error_column("{ nm = [400, 500], value = [1, nan] }", "value[1] is nan"), 43);
    EXPECT_EQ(error_column("{ nm = [400, 500], value = [1, 1e38] }", "value[1] is 1e+38"), 43);
    EXPECT_EQ(error_column("{ nm = [], value = [] }", "nm is empty"), 14);
    EXPECT_EQ(error_column("{ nm = [400, 500], value = [1] }", "value has 1 numbers and nm 2"), 31);
    EXPECT_EQ(error_column("{ nm = [400, 500] }", "has no \"value\""), 12);
    EXPECT_EQ(error_column("{ nm = 400, value = [1] }", "write an array"), 14);
}

TEST_F(SpectrumForms, UnknownFormsAndValuesAreRefused) {
    EXPECT_EQ(error_column("\"white\"", "give a number, a table"), 1);
    EXPECT_EQ(error_column("{}", "does not say what spectrum"), 12);
    EXPECT_EQ(error_column("{ illuminat = \"D65\" }", "did you mean \"illuminant\"?"), 14);
    EXPECT_EQ(error_column("{ illuminant = \"D65\", scal = 2 }", "did you mean \"scale\"?"), 34);
    EXPECT_EQ(error_column("{ illuminant = \"D64\" }", "D65"), 14);
    EXPECT_EQ(error_column("{ illuminant = \"D65\", scale = -1 }", "at least 0"), 34);
    EXPECT_EQ(error_column("{ illuminant = \"D65\", line_nm = 405 }", "has both"), 12);
    EXPECT_EQ(error_column("{ blackbody_kelvin = 0 }", "at least 500"), 14);
    EXPECT_EQ(error_column("{ line_nm = 405, width_nm = 0 }", "at least 0.001"), 29);
    EXPECT_EQ(error_column("{ gaussian_nm = 405 }", "has no \"sigma_nm\""), 12);
    EXPECT_EQ(error_column("{ rgb = [0.5, -2, 0.5] }", "rgb[1] is -2"), 26);
    EXPECT_EQ(error_column("{ rgb = [0.5, 0.5] }", "give 3"), 14);
    EXPECT_EQ(error_column("[]", "sum of 0 spectra"), 1);
    EXPECT_EQ(error_column("[1, true]", "radiance[1] is a boolean"), 16);
}
