#include "reradiant/error.h"
#include "reradiant/spectral_files.h"
#include "tests/spectral/refusal.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>

using namespace reradiant;

namespace {

/// These tests read the '#' lines and headings of a re-radiation CSV as people and spreadsheets
/// write them.
class MatrixHeaders : public test::ScratchFolder {
protected:
    ReradiationMatrix read(const std::string& text) const {
        return read_reradiation(write("m.csv", text));
    }
    std::pair<int, int> refused(const std::string& text, const std::string& words) const {
        return refusal([&] { read(text); }, words);
    }
    void expect_percent(const std::string& text) const {
        const ReradiationMatrix matrix = read(text);
        EXPECT_EQ(matrix.values(0, 0), 0.3) << text;
        EXPECT_EQ(matrix.values(1, 0), 0.02) << text;
        EXPECT_EQ(matrix.values(1, 1), 0.4) << text;
    }
    const std::string head = "# quantity: per-band\n# orientation: rows-emission\n";
    const std::string measured = "# kind: measured\n" + head;
    const std::string body = "nm,400,410\n400,0.3,0\n410,0.02,0.4\n";
    const std::string percents = "400,30,0\n410,2,40\n";
};

} // namespace

TEST_F(MatrixHeaders, PercentIsReadInEveryCaseAndPlace) {
    const std::string table = "nm,400,410\n" + percents;
    for (const char* line :
         {"# unit: percent\n", "# Unit: percent\n", "# UNIT: Percent\n", "# unit = percent\n",
          "#units=%\n", "# unit: per cent\n", "\"# Value unit: percent\",,\n"}) {
        expect_percent(measured + line + table);
        expect_percent(line + measured + table);
    }
    expect_percent(measured + "nm,400,410\n# unit: percent\n" + percents);
    expect_percent(measured + "nm,400,410\n" + percents + "# unit: percent\n");
    expect_percent(measured + "nm (values in %),400,410\n" + percents);
    EXPECT_EQ(refused(measured + "# unit: 1\nnm (%),400,410\n" + percents, "percent"),
              (std::pair{5, 1}));
}

TEST_F(MatrixHeaders, KeysAndValuesAreReadInAnyCase) {
    const ReradiationMatrix matrix =
        read("# RERADIATION\n# Quantity = Per-Band\n# ORIENTATION: Rows-Emission\n# Kind: Measured "
             "(45/0)\n# Anti_Stokes: Allowed\n# Geometry: 45/0\n" +
             body);
    EXPECT_EQ(matrix.kind, MatrixKind::Measured);
    EXPECT_TRUE(matrix.anti_stokes_allowed);
    EXPECT_EQ(matrix.geometry, "45/0");
    EXPECT_EQ(refused("# KIND: guessed\n" + head + body, "guessed"), (std::pair{1, 9}));
    EXPECT_EQ(refused("# kind: measured\n# Kind: model\n" + head + body, "twice"),
              (std::pair{2, 3}));
    EXPECT_EQ(refused(head + "# knid: measured\n" + body, "did you mean 'kind'"),
              (std::pair{3, 3}));
    EXPECT_EQ(refused(head + "# orientaion: rows-emission\n" + body, "did you mean 'orientation'"),
              (std::pair{3, 3}));
    // A line that resembles no key is a remark.
    EXPECT_EQ(read(head + "# source: a lab\n# scale: linear\n# licence = CC0\n# note\n" + body)
                  .values(0, 0),
              0.3);
}

TEST_F(MatrixHeaders, UnitsAndFactorsThatAreNotAppliedAreRefused) {
    for (const char* unit : {"permille", "ppm", "counts", "W/m2/nm", ""})
        EXPECT_EQ(refused("# unit: " + std::string(unit) + "\n" + head + body, "unit").first, 1)
            << unit;
    EXPECT_EQ(refused("# unit: 1/nm\n" + head + body, "density-per-nm"), (std::pair{1, 9}));
    EXPECT_EQ(
        read("# unit: 1/nm\n# quantity: density-per-nm\n# orientation: rows-emission\n" + body)
            .values(1, 0),
        0.2);
    for (const char* line : {"# factor: 0.01\n", "# Scale factor = 0.01\n", "# multiplier: 2\n"})
        EXPECT_EQ(refused(line + head + body, "factor"), (std::pair{1, 3})) << line;
    for (const char* unit : {"1", "1 (white reflects 1)", "total radiance factor", "nm"})
        EXPECT_EQ(read("# unit: " + std::string(unit) + "\n" + head + body).values(1, 0), 0.02);
}

TEST_F(MatrixHeaders, WhatSpreadsheetsSaveAgainIsRead) {
    const ReradiationMatrix plain = read("# reradiation\n" + measured + body);
    const std::string padded = "# reradiation,,\n# kind: measured,,\n# quantity: per-band,,\n"
                               "# orientation: rows-emission,,\n,,\n" +
                               body;
    std::string semicolons = padded;
    std::replace(semicolons.begin(), semicolons.end(), ',', ';');
    const std::string quoted =
        "\"# reradiation\"\n\"# kind: measured\"\n\"# quantity: per-band\",,\n"
        "\"# orientation: rows-emission\"\n" +
        body;
    for (const std::string& text :
         {padded, semicolons, quoted, "sep=,\n" + padded, "SEP=;\n" + semicolons,
          "Orange paint\n" + padded, "Orange paint, second batch,,\n\n" + padded,
          "A paint sample\n" + quoted}) {
        ASSERT_TRUE(holds_reradiation(write("m.csv", text))) << text;
        const ReradiationMatrix matrix = read(text);
        EXPECT_EQ(matrix.values, plain.values) << text;
        EXPECT_EQ(matrix.kind, MatrixKind::Measured) << text;
    }
    // A row that comes before its declarations is no title.
    EXPECT_EQ(refused("400,0.3,0\n" + measured + body, "quantity").first, 1);
}

TEST_F(MatrixHeaders, ColumnsOfTheLongFormStandInAnyOrder) {
    const ReradiationMatrix matrix =
        read(head + "Emission_nm,excitation_nm,value\n400,400,0.3\n410,400,0.02\n410,410,0.4\n");
    EXPECT_EQ(matrix.values, read(head + body).values);
    EXPECT_EQ(refused(head + "emission_nm,value\n400,0.3\n", "headings"), (std::pair{3, 1}));
    EXPECT_EQ(refused(head + "emission_nm,excitation_nm,error\n400,400,0.3\n", "headings"),
              (std::pair{3, 1}));
    EXPECT_EQ(refused(head + "value,emission_nm,excitation_nm\n30,400,400\n", "percent"),
              (std::pair{4, 1}));
}

TEST_F(MatrixHeaders, AMatrixIsNoSpectrum) {
    const auto spectrum = [&](const std::string& text) {
        return refusal([&] { read_spectrum(write("s.csv", text)); }, "re-radiation matrix");
    };
    EXPECT_EQ(spectrum("# reradiation\n" + measured + "nm,400\n400,0.5\n410,0.1\n420,0.2\n"),
              (std::pair{1, 1}));
    EXPECT_EQ(spectrum("# note\n" + measured + "nm,400\n400,0.5\n").first, 3);
    EXPECT_EQ(spectrum("\"# Orientation = rows-emission\",\nnm,400\n400,0.5\n").first, 1);
    EXPECT_EQ(spectrum("excitation_nm,emission_nm,value\n400,400,0.5\n").first, 1);
    // A spectrum may speak of quantities.
    const auto file =
        write("s.csv", "# quantity: spectral reflectance\nnm,value\n400,0.4\n500,0.5\n");
    EXPECT_FALSE(holds_reradiation(file));
    EXPECT_EQ(read_spectrum(file)(500.0), 0.5);
}
