#include "host/fit/data/prepared_target.h"
#include "reradiant/bispectral_data.h"
#include "reradiant/error.h"
#include "tests/film/film_fixtures.h"
#include "tests/fit/fit_cases.h"

#include <gtest/gtest.h>

#include <string>

using namespace reradiant;

namespace {

const std::string header = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                           "# kind: measured\n";
const std::string measure_headings =
    "theta_i_deg,theta_o_deg,phi_deg,lambda_i_nm,lambda_o_nm,value,stderr,part\n";

class DataTest : public ::testing::Test {
protected:
    BispectralData read(const std::string& text) const {
        put_bytes(folder / "data.csv", text);
        return read_bispectral_data(folder / "data.csv");
    }
    /// The text must be refused at line:column with these words.
    void expect_refused(const std::string& text, const std::string& place,
                        const std::string& words) const {
        try {
            read(text);
            ADD_FAILURE() << "not refused: " << text;
        } catch (const Error& error) {
            const std::string message = error.what();
            EXPECT_EQ(error.exit_code(), 2);
            EXPECT_NE(message.find("data.csv:" + place), std::string::npos) << message;
            EXPECT_NE(message.find(words), std::string::npos) << message;
        }
    }
    const TemporaryFolder folder;
};

} // namespace

TEST_F(DataTest, GapsBecomeNan) {
    const BispectralData data = read(header + "nm,400,410\n400,0.5,nan\n410,0.1,0.5\n");
    ASSERT_EQ(data.blocks.size(), 1u);
    EXPECT_FALSE(data.blocks[0].geometry);
    EXPECT_TRUE(std::isnan(data.blocks[0].value(0, 1)));
    EXPECT_EQ(data.blocks[0].value(1, 0), 0.1);
    EXPECT_EQ(data.measured_count(), 3);
}

TEST_F(DataTest, GapsOfEveryProgramBecomeNan) {
    const char* words[] = {"NaN", "NAN", "nan",  "NA",   "N/A",  "n/a",    "#N/A", "--",    "-",
                           "",    " ",   "null", "None", "<NA>", "\"NA\"", "\"\"", "masked"};
    for (const std::string gap : words) {
        const BispectralData wide = read(header + "nm,400,410\n400,0.5," + gap + "\n410,0.1,0.5\n");
        EXPECT_TRUE(std::isnan(wide.blocks[0].value(0, 1))) << gap;
        EXPECT_EQ(wide.measured_count(), 3) << gap;
        const BispectralData list = read(header +
                                         "excitation_nm,emission_nm,value\n400,400,0.5\n"
                                         "400,410,0.1\n410,410," +
                                         gap + "\n");
        EXPECT_EQ(list.measured_count(), 2) << gap;
        const BispectralData measured = read(measure_headings + "45,0,0,400,400,0.1," + gap +
                                             ",diffuse\n45,0,0,400,410," + gap + ",0.1,diffuse\n");
        EXPECT_TRUE(std::isnan(measured.blocks[0].sigma(0, 0))) << gap;
        EXPECT_TRUE(std::isnan(measured.blocks[0].value(1, 0))) << gap;
    }
    expect_refused(header + "nm,400,410\n400,0.5,?\n410,0.1,0.5\n", "6:9", "'?'");
    expect_refused(header + "nm,400,410\n400,0.5,inf\n410,0.1,0.5\n", "6:9", "inf");
    expect_refused(header + "nm,400,410\nNA,0.5,0\n410,0.1,0.5\n", "6:1", "missing");
    expect_refused(header + "nm,400,410\n400,0.5\n410,0.1,0.5\n", "6:", "1 values");
}

TEST_F(DataTest, AxesInAnyOrderAndRoundedAreOneGrid) {
    const BispectralData sorted =
        read(header + "nm,300,390\n390,0.1,0.5\n386.67,0.2,0\n383.33,0.3,NA\n380,0.4,0\n");
    EXPECT_EQ(sorted.emission, (WavelengthGrid{380.0, 10.0 / 3.0, 4}));
    EXPECT_EQ(sorted.blocks[0].value(3, 1), 0.5);
    EXPECT_TRUE(std::isnan(sorted.blocks[0].value(1, 1)));
    const BispectralData measured =
        read(measure_headings + "45,0,0,300,390,0.1,0,diffuse\n45,0,0,300,386.67,0.2,0,diffuse\n"
                                "45,0,0,300,383.33,0.3,0,diffuse\n45,0,0,300,380,0.4,0,diffuse\n");
    EXPECT_EQ(measured.emission, sorted.emission);
    EXPECT_EQ(measured.measured_count(), 4);
    EXPECT_NEAR(measured.blocks[0].value(0, 0), 0.4 * 3.14159265358979, 1e-12);
}

TEST_F(DataTest, MeasurementsBecomeBlocksOfRadianceFactors) {
    const BispectralData data = read("# kind: measured\n" + measure_headings +
                                     "45,0,0,400,400,0.1,0.01,diffuse\n"
                                     "45,0,0,400,410,0.02,0,diffuse\n"
                                     "45,0,0,400,410,9,0,specular\n"
                                     "45,60,180,400,400,0.2,0,diffuse\n");
    ASSERT_EQ(data.blocks.size(), 2u);
    EXPECT_EQ(data.blocks[1].geometry->theta_o_deg, 60.0);
    EXPECT_NEAR(data.blocks[0].value(0, 0), 0.1 * 3.14159265358979, 1e-12);
    EXPECT_NEAR(data.blocks[0].sigma(0, 0), 0.01 * 3.14159265358979, 1e-12);
    EXPECT_TRUE(std::isnan(data.blocks[0].sigma(1, 0))); // 0 stands for unknown
    EXPECT_TRUE(std::isnan(data.blocks[1].value(1, 0)));
}

TEST_F(DataTest, LightOfSlabsIsLeftOutAndThatOfTheirDyesIsRefused) {
    const std::string rows = "45,0,0,400,400,0.1,0.01,diffuse\n"
                             "45,0,0,400,410,0.02,0,diffuse\n"
                             "45,0,0,400,400,0.3,0,slab\n"
                             "45,0,0,400,410,0,0,slab\n";
    const BispectralData data = read(measure_headings + rows);
    EXPECT_NEAR(data.blocks.at(0).value(0, 0), 0.1 * 3.14159265358979, 1e-12);
    EXPECT_NEAR(data.blocks.at(0).value(1, 0), 0.02 * 3.14159265358979, 1e-12);
    expect_refused(measure_headings + rows + "45,0,0,400,420,0.01,0,slab\n", "6:23",
                   "dyes in its layers");
}

TEST_F(DataTest, MeasurementsOfSpreadsheetsAndTheirUnits) {
    const std::string row = "45,0,0,400,400,0.1,0.01,diffuse\n";
    const std::string padded =
        "sep=,\n\"# measure, model full\",,\n\"# Quantity: Per-Band\",,\n"
        "theta_i_deg,theta_o_deg,phi_deg,lambda_i_nm,lambda_o_nm,value,stderr,part,,\n"
        "45,0,0,400,400,0.1,0.01,diffuse,,\n,,,,,,,,,\n";
    for (const std::string& text :
         {padded, "# Anti-Stokes = refused\n# unit: 1/sr\n" + measure_headings + row})
        EXPECT_NEAR(read(text).blocks.at(0).value(0, 0), 0.1 * 3.14159265358979, 1e-12) << text;
    expect_refused("# unit: percent\n" + measure_headings + row, "1:9", "1/sr");
    expect_refused(measure_headings + row + "# Units = counts\n", "3:11", "counts");
    expect_refused("# factor: 2\n" + measure_headings + row, "1:3", "factor");
    expect_refused("# Orientation: rows-excitation\n" + measure_headings + row, "1:16",
                   "contradicts");
    expect_refused("# anti-stokes: perhaps\n" + measure_headings + row, "1:16", "perhaps");
}

TEST_F(DataTest, BlocksSurviveWritingAndReading) {
    BispectralData data = noisy_data(true_matrix(two_fluorophores()), 0.01, true, 1);
    data.blocks[0].geometry = {45.0, 10.0, 180.0};
    data.blocks[0].value(3, 2) = not_measured;
    write_bispectral_data(folder / "out.csv", data);
    const BispectralData back = read_bispectral_data(folder / "out.csv");
    ASSERT_EQ(back.blocks.size(), 1u);
    EXPECT_EQ(back.emission, data.emission);
    EXPECT_TRUE(std::isnan(back.blocks[0].value(3, 2)));
    // 12 digits are written.
    EXPECT_NEAR(back.blocks[0].value(20, 20), data.blocks[0].value(20, 20), 1e-10);
    EXPECT_NEAR(back.blocks[0].sigma(20, 20), 0.01, 1e-12);
}

TEST_F(DataTest, BadInputIsRefusedAtItsPlace) {
    expect_refused("# reradiation\n# orientation: rows-emission\nnm,400\n400,0.1\n", "",
                   "quantity");
    expect_refused("# reradiation\n# quantity: per-band\nnm,400\n400,0.1\n", "", "orientation");
    expect_refused(header + "# quantity: density-per-nm\nnm,400\n400,0.1\n", "5:", "quantity");
    expect_refused(header + "nm,400,410\n400,0.1\n", "6:", "");
    expect_refused(header + "nm,400,400\n400,0.1,0.1\n", "5:8", "400");
    expect_refused(header + "nm,400,410\n400,50,0\n410,3,60\n", "6:5", "percent");
    expect_refused(header + "nm,0.4,0.41\n0.4,0.1,0\n0.41,0,0.1\n", "1:1", "nm");
    expect_refused(measure_headings + "45,0,0,400,400,0.1,0,diffuse\n45,0,0,400,410,30,0,diffuse\n",
                   "3:16", "percent");
    expect_refused("##TITLE= x\n", "1:1", "JCAMP-DX");
    expect_refused(header + "nm,400\n400,nan\n", "1:1", "no entry was measured");
    expect_refused("# quantity: density-per-nm\n" + measure_headings, "1:13", "contradicts");
    expect_refused(measure_headings +
                       "45,0,0,400,400,0.1,0,diffuse\n45,0,0,400,400,0.1,0,diffuse\n",
                   "3:8", "twice");
    expect_refused(measure_headings + "45,,,400,400,0.1,0,diffuse\n", "2:4", "directions");
    expect_refused(measure_headings + "45,0,0,400,400,0.1,0\n", "2:", "values in this line");
    expect_refused(measure_headings + "95,0,0,400,400,0.1,0,diffuse\n", "2:1", "degrees");
}

TEST(Target, NoiseIsSeenThroughTheSignal) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    for (const double noise : {1e-4, 1e-3, 1e-2}) {
        const BispectralData data = noisy_data(truth, noise * stokes_peak(truth), false, 3);
        const PreparedTarget prepared = prepare_target(data, {false, 10.0});
        EXPECT_TRUE(prepared.noise_is_estimated);
        // About 900 correlated differences know the scale to 10 %; curvature of the signal adds.
        EXPECT_NEAR(prepared.noise / (noise * stokes_peak(truth)), 1.0, 0.3) << noise;
    }
}

TEST(Target, NegativesAreNoiseUnlessTheDarkSignalIsOff) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    BispectralData data = noisy_data(truth, 0.01 * stokes_peak(truth), false, 3);
    const PreparedTarget noisy = prepare_target(data, {false, 10.0});
    EXPECT_LT(noisy.target.value.minCoeff(), 0.0);
    EXPECT_FALSE(says(noisy.notes, "negative"));
    data.blocks[0].value.row(30).array() -= 0.1 * stokes_peak(truth); // 49 bands at 680 nm
    const PreparedTarget off = prepare_target(data, {false, 10.0});
    EXPECT_EQ(off.target.value.minCoeff(), 0.0);
    EXPECT_TRUE(says(off.notes, "negative"));
}

TEST(Target, SpillAndDiagonalAreNotUsed) {
    const PreparedTarget prepared =
        prepare_target(noisy_data(true_matrix(two_fluorophores()), 1e-3, true, 3), {false, 10.0});
    const FitTarget& target = prepared.target;
    for (int i = 0; i < target.excitation.count; ++i)
        for (int o = 0; o < target.emission.count; ++o)
            EXPECT_EQ(target.weight(o, i) > 0.0,
                      target.emission.centre_nm(o) > target.excitation.centre_nm(i) + 10.5);
    EXPECT_TRUE(std::isnan(prepared.diagonal(0))); // 300 nm is no emission band
    EXPECT_NEAR(prepared.diagonal(20), 0.1, 0.01);
}

TEST(Target, SaturatedPlateauIsLeftOutAndNamed) {
    BispectralData data = noisy_data(true_matrix(two_fluorophores()), 1e-3, true, 3);
    const double limit = 0.5 * stokes_peak(true_matrix(two_fluorophores()));
    int cut = 0;
    for (double& value : data.blocks[0].value.reshaped())
        if (value > limit) {
            value = limit;
            ++cut;
        }
    ASSERT_GT(cut, 4);
    const PreparedTarget prepared = prepare_target(data, {false, 10.0});
    EXPECT_LT(prepared.target.value.maxCoeff() * prepared.target.scale, limit);
    ASSERT_FALSE(prepared.notes.empty());
    EXPECT_NE(prepared.notes[0].find("saturated"), std::string::npos);
}
