#include "host/spectral/text/number_table.h"
#include "reradiant/spectral_files.h"
#include "tests/spectral/refusal.h"
#include "tests/support/scratch_folder.h"

using namespace reradiant;

namespace {

/// Tables of two columns as spreadsheets, scripts and instruments write them.
class SpectrumTables : public test::ScratchFolder {
protected:
    static std::filesystem::path input(const std::string& name) {
        return std::filesystem::path(RERADIANT_SOURCE_DIR) / "tests" / "spectral" / "inputs" / name;
    }
    Spectrum read(const std::string& text) const { return read_spectrum(write("s.csv", text)); }
    /// Line and column of the refusal, which must hold these words.
    std::pair<int, int> place(const std::string& text, const std::string& words = "") const {
        return refusal([&] { read(text); }, words);
    }
};

} // namespace

TEST_F(SpectrumTables, AHeadingHasNoNumberInFront) {
    EXPECT_EQ(read_spectrum(input("two-heads.csv"))(400), 0.1);
    EXPECT_EQ(read_spectrum(input("two-heads.csv"))(650), 0.85);
    EXPECT_EQ(read("Serial,7\nDate;2021-03-04\nnm;R\n400;0.1\n500;0.3\n")(450), 0.2);
    EXPECT_EQ(read(",0\n400,0.1\n500,0.3\n")(400), 0.1); // pandas' heading of a series
    // A heading behind the data, and numbers that are none.
    EXPECT_EQ(place("400,0.1\nnm,R\n500,0.3\n", "'nm' is not a number"), (std::pair{2, 1}));
    EXPECT_EQ(refusal([] { read_spectrum(input("letter-o.csv")); }, "'4OO'"), (std::pair{1, 1}));
    EXPECT_EQ(place("nm,R\n4OO,0.1\n450,0.2\n", "'4OO'"), (std::pair{2, 1}));
    EXPECT_EQ(place("+4x,0.1\n450,0.2\n", "'+4x'"), (std::pair{1, 1}));
    EXPECT_EQ(place(".4.0,0.1\n450,0.2\n", "'.4.0'"), (std::pair{1, 1}));
    EXPECT_EQ(place("x400,0.1\n450,0.2\n", "'x400'"), (std::pair{1, 1}));
    EXPECT_EQ(place("nan,0.1\n450,0.2\n", "missing"), (std::pair{1, 1}));
    EXPECT_EQ(place("400-410,0.1\n450,0.2\n", "'400-410'"), (std::pair{1, 1}));
}

TEST_F(SpectrumTables, QuotedNumbersAndUnitsBehindThemAreRead) {
    EXPECT_EQ(read_spectrum(input("quoted.csv"))(400), 0.1);
    EXPECT_EQ(read_spectrum(input("quoted.csv"))(700), 0.9);
    EXPECT_EQ(read("\"paint; red, matt\",\"R\"\n\"400\",\"0.1\"\n500,0.3\n")(450), 0.2);
    EXPECT_EQ(read_spectrum(input("unit-first.csv"))(400), 0.9);
    EXPECT_EQ(read_spectrum(input("unit-first.csv"))(450), 0.15);
    EXPECT_EQ(read("400 nm,0.9\n500 nm,0.1\n")(400), 0.9);
    EXPECT_EQ(place("0.4um,0.9\n0.5um,0.1\n", "'0.4um'"), (std::pair{1, 1}));
    EXPECT_EQ(place("400mm,0.9\n", "'400mm'"), (std::pair{1, 1}));
}

TEST_F(SpectrumTables, StatedUnitsOfWavelengthAreConverted) {
    for (const char* name : {"refl-um.csv", "refl-angstrom.csv"}) {
        const Spectrum spectrum = read_spectrum(input(name));
        EXPECT_NEAR(spectrum(400), 0.1, 1e-12) << name;
        EXPECT_NEAR(spectrum(550), 0.5, 1e-12) << name;
        EXPECT_NEAR(spectrum(700), 0.9, 1e-12) << name;
    }
    // 1e7 / 25000, 20000 and 16667 are 400, 500 and 599.988 nm; between, the table is linear.
    const Spectrum wavenumbers = read_spectrum(input("refl-wavenumber.csv"));
    EXPECT_EQ(wavenumbers(400), 0.1);
    EXPECT_EQ(wavenumbers(500), 0.2);
    EXPECT_NEAR(wavenumbers(1e7 / 16667), 0.8, 1e-12);
    EXPECT_NEAR(wavenumbers(450), 0.15, 1e-12);
    for (const char* heading :
         {"um,R", "Wavelength (um),R", "wavelength_um,R", "Wavelength / \xc2\xb5m,R",
          "Wavelength [\xce\xbcm],R", "lambda (\xb5m)\tR", "micrometers,R", "\"Microns\",\"R\"",
          "# um R", "# wavelength_um,R", "Sample,A\nwavelength (um),R", "wavelength (um) R"})
        EXPECT_NEAR(read(std::string(heading) + "\n0.4,0.1\n0.6,0.3\n")(500), 0.2, 1e-12)
            << heading;
    for (const char* heading : {"A,R", "Angstroms,R", "Wavelength (\xc3\x85),R", "lambda_A,R",
                                "Wavelength (A) R", "\xe2\x84\xab;R"})
        EXPECT_NEAR(read(std::string(heading) + "\n4000,0.1\n6000,0.3\n")(500), 0.2, 1e-12)
            << heading;
    for (const char* heading : {"cm-1,R", "Wavenumber,R", "Wavenumber (cm^-1),R", "1/cm,R",
                                "cm\xe2\x81\xbb\xc2\xb9,R", "Wavenumbers cm-1"})
        EXPECT_EQ(read(std::string(heading) + "\n25000,0.1\n20000,0.3\n")(500), 0.3) << heading;
    EXPECT_NEAR(read("Energy (eV),R\n2.479683968664,0.3\n3.09960496083,0.1\n")(500), 0.3, 1e-9);
    EXPECT_EQ(read("THz,R\n599.584916,0.3\n749.481145,0.1\n")(500), 0.3);
    for (const char* heading : {"nm,R", "Wavelength,R", "Wavelength (nm),R", "lambda R",
                                "Sample A,1", "# A lamp", "# nm value", "x,y"})
        EXPECT_EQ(read(std::string(heading) + "\n400,0.1\n600,0.3\n")(500), 0.2) << heading;
}

TEST_F(SpectrumTables, Case35WhatCannotBeInNanometresIsRefused) {
    EXPECT_EQ(place("0.4,0.1\n0.7,0.9\n", "micrometres"), (std::pair{1, 1}));
    EXPECT_EQ(place("# c\nwl,R\n4000,0.1\n7000,0.9\n", "Angstrom"), (std::pair{3, 1}));
    EXPECT_EQ(place("14286,0.9\n25000,0.1\n", "1/cm"), (std::pair{1, 1}));
    EXPECT_EQ(place("um,R\n400,0.1\n700,0.9\n", "check the unit").first, 2);
    EXPECT_EQ(place("pixel,R\n400,0.1\n700,0.9\n", "'pixel'").first, 1);
    EXPECT_EQ(place("cm-1,R\n0,0.1\n25000,0.9\n", "0 1/cm").first, 2);
    // Near infrared beside the visible is common and right.
    EXPECT_EQ(read("350,0.1\n2500,0.9\n")(350), 0.1);
}

TEST_F(SpectrumTables, StatedPercentIsReadAsPercent) {
    for (const char* heading : {"nm,%R", "nm,R%", "nm,R (%)", "nm,%T", "nm reflectance_percent",
                                "nm;Percent reflectance", "Wavelength (nm)\tR [%]", "# nm %"})
        EXPECT_EQ(read(std::string(heading) + "\n400,10\n500,70\n")(500), 0.7) << heading;
    EXPECT_EQ(read("nm,R\n400,10%\n500,70 %\n")(500), 0.7);
    EXPECT_EQ(read("nm,%R\n400,10%\n500,70\n")(400), 0.1);
    EXPECT_EQ(read("Humidity,50%\nnm,R\n400,0.1\n500,0.7\n")(500), 0.7);
    EXPECT_EQ(read("nm,%R\nSample,paint\n400,10\n500,70\n")(500), 0.7);
    EXPECT_EQ(read("Humidity,%\nnm,R\n400,0.1\n500,0.7\n")(500), 0.7);
    // A lamp has any magnitude.
    EXPECT_EQ(read("nm,power\n400,1000\n500,70000\n")(500), 70000);
}

TEST_F(SpectrumTables, PercentIsFoundWhereverTheHeadStatesIt) {
    for (const char* text :
         {"Wavelength (nm) Total reflectance (%)\n400 40\n500 60\n",
          "# Wavelength (nm) Total reflectance (%)\n400 40\n500 60\n",
          "\"Wavelength\n(nm)\",\"Reflectance\n(%)\"\n400,40\n500,60\n",
          "Wavelength (nm)\tR (%), SCI\n400\t40\n500\t60\n",
          "Y Units,%R\nWavelength,Value\n400,40\n500,60\n",
          "(nm),(%)\nWavelength,Reflectance\n400,40\n500,60\n",
          "Wavelength,Reflectance\nnm,%\n400,40\n500,60\n",
          "X Units: Wavelength (nm)\nY Units: Reflectance (%)\n\n400 40\n500 60\n",
          "# unit: percent\nnm,value\n400,40\n500,60\n", "nm,value\n# Unit = %\n400,40\n500,60\n",
          "\"Wavelength (nm)\tR (%)\"\n400\t40\n500\t60\n", "# Reflectance (%)\n400 40\n500 60\n",
          "# values in percent\nnm,R\n400,40\n500,60\n", "tile of 5\"\nnm,%R\n400,40\n500,60\n",
          "nm,per cent\n400,40\n500,60\n", "nm,R (0-100%)\n400,40\n500,60\n"})
        EXPECT_NEAR(read(text)(450), 0.5, 1e-12) << text;
    EXPECT_NEAR(read_spectrum(write("s.spd", "# unit: percent\n400 40\n500 60\n"))(450), 0.5,
                1e-12);
    // A sign behind a digit belongs to a sample's name.
    for (const char* heading :
         {"nm,Grey 50%", "nm,R at 50% RH", "nm,Spectralon SRS-50 (50 %)", "nm,R (0-1; not %)",
          "# unit: 1\nnm,R", "# humidity in %\nnm,R", "# unit: 1 (arbitrary)\nnm,R",
          "# unit: 1; by 10 nm\nnm,R", "# at 20 % RH\nnm,R"})
        EXPECT_EQ(read(std::string(heading) + "\n400,0.5\n500,0.5\n")(450), 0.5) << heading;
    EXPECT_EQ(place("# unit: 1\nnm,%R\n400,40\n", "fractions"), (std::pair{1, 1}));
    EXPECT_EQ(place("nm,R\n400,40\n# unit: percent\n500,60\n", "behind the values").first, 3);
}

TEST_F(SpectrumTables, TitlesNameNoUnits) {
    for (const char* head :
         {"A paint sample\nWavelength R", "A,test\nWavelength,R", "Lambda A,B",
          "PM log\nWavelength R", "Time: 10:30\nnm,R", "Time,10:30\nnm,R",
          "Energy saving lamp\nnm,R", "Low energy lamp, type 3\nnm,R", "Second sample,white\nnm,R",
          "Energy saving lamp,x", "Path length (mm),10 mm\nnm,R",
          "Slit (um): 50\nWavelength (nm),R", "Path length (mm),x\nWavelength,R", "# Slit in mm",
          "Power factor: 0.95\nnm,R", "## author=me\nnm,value"})
        for (const char* separator : {",", "\t"})
            EXPECT_EQ(read(std::string(head) + "\n400" + separator + "0.1\n600" + separator +
                           "0.3\n2500" + separator + "0.3\n")(500),
                      0.2)
                << head;
    // The axis of the light may have other names than its unit's.
    for (const char* head : {"Optical frequency (THz)  R", "Light frequency/THz  R",
                             "# Frequency in THz", "X Units: Frequency (THz)"})
        EXPECT_NEAR(read(std::string(head) + "\n599.584916 0.3\n749.481145 0.1\n")(500), 0.3, 1e-9)
            << head;
    for (const char* head : {"inverse um,R", "1/um,R", "Wavenumber (um^-1),R"})
        EXPECT_NEAR(read(std::string(head) + "\n2,0.3\n2.5,0.1\n")(500), 0.3, 1e-12) << head;
    EXPECT_NEAR(read("X Units: Wavelength (micrometers)\n0.4 0.1\n0.6 0.3\n")(500), 0.2, 1e-12);
    EXPECT_EQ(place("# wavelength unit: um\nnm,R\n400,0.1\n", "another line"), (std::pair{2, 1}));
    EXPECT_EQ(place("Wavelength (inch),R\n400,0.1\n", "'inch'"), (std::pair{1, 1}));
}

TEST_F(SpectrumTables, Case35WhatIsSaidAndNotReadIsRefused) {
    for (const char* heading :
         {"Band,Reflectance", "Angle (deg),I", "Temperature (K),R", "Year,Value", "Pixel number,R",
          "inverse nm,R", "Frequency,R", "Energy (keV),R", "Angle of incidence,R"})
        EXPECT_EQ(place(std::string(heading) + "\n400,0.1\n500,0.2\n", "is not a wavelength"),
                  (std::pair{1, 1}))
            << heading;
    EXPECT_EQ(place("# Year,Value\n400,0.1\n500,0.2\n", "'Year'"), (std::pair{1, 1}));
    EXPECT_EQ(place("# Band Reflectance\n400 0.1\n500 0.2\n", "'Band'"), (std::pair{1, 1}));
    EXPECT_EQ(read("# Energy lamp\n400,0.1\n500,0.2\n")(400), 0.1);
    for (const char* head :
         {"Wavelength (nm),Absorbance", "nm,log(1/R)", "nm,R (dB)", "nm,K/S", "nm,1-R",
          "nm,Kubelka-Munk", "# unit: permille\nnm,R", "Y Units: Absorbance\nnm,R"})
        EXPECT_EQ(place(std::string(head) + "\n400,0.1\n500,0.2\n", "no reflectance").first, 1)
            << head;
    for (const char* line : {"Scale factor:,0.01,,", "Multiplier,0.01,", "Scale 0.01",
                             "# factor: 0.01", "# scaled by 100", "Y factor = 1e-2"})
        EXPECT_EQ(place(std::string(line) + "\nWavelength,Value\n400,45\n", "factor"),
                  (std::pair{1, 1}))
            << line;
    EXPECT_EQ(read("Scale factor,1\nnm,R\n400,0.5\n")(400), 0.5);
}

TEST_F(SpectrumTables, Case35ARowThatWentWrongIsNoHeading) {
    EXPECT_EQ(place(",0.9\n400,0.1\n500,0.2\n", "missing"), (std::pair{1, 1}));
    EXPECT_EQ(place("x400,0.5,\n410,0.6,\n420,0.7,\n", "'x400'"), (std::pair{1, 1}));
    EXPECT_EQ(place("l00,50%\n410,51%\n", "'l00'"), (std::pair{1, 1}));
    EXPECT_EQ(place("(400,0.1)\n500,0.2\n", "'(400'"), (std::pair{1, 1}));
    EXPECT_EQ(place("Infinity,0.1\n500,0.2\n", "finite"), (std::pair{1, 1}));
    EXPECT_EQ(place("nm;value\n400;0.1\n;0.9\n500;0.2\n", "missing").first, 3);
    EXPECT_EQ(place(";0.9\n500;0.2\n", "missing").first, 1);
    EXPECT_EQ(place("\xef\xbb\xbf\xef\xbb\xbf"
                    "400,0.5,\n410,0.6,\n")
                  .first,
              1);
}

TEST_F(SpectrumTables, RowsAreSortedAndGivenOnce) {
    EXPECT_EQ(read("500,1\n400,2\n")(400), 2.0);
    EXPECT_EQ(read("500,1\n700,3\n400,2\n")(600), 2.0);
    EXPECT_EQ(place("500,1\n400,2\n500,1\n", "given twice"), (std::pair{3, 1}));
    const NumberTable three =
        read_number_table(write("m.csv", "nm,n,k\n600,1.5,3\n500,0.5,4\n"), 3);
    EXPECT_EQ(three.columns[2], (std::vector<double>{4, 3}));
}

TEST_F(SpectrumTables, Case35GapsAreRefusedAndNeverClosedUp) {
    for (const char* gap :
         {"", "NA", "N/A", "--", "-", "nan", "NaN", "NAN", "null", "None", "#N/A", "\"\""})
        EXPECT_EQ(place("400,0.1\n500," + std::string(gap) + "\n600,0.2\n", "missing").first, 2)
            << gap;
    EXPECT_EQ(place("400,,0.1\n500,,0.2\n", "3 values"), (std::pair{1, 1}));
    EXPECT_EQ(place("400,inf\n", "inf"), (std::pair{1, 5}));
    EXPECT_EQ(read("nm,R,,\n400,0.1,,\n,,,\n500,0.3,,\n")(450), 0.2); // a spreadsheet's margin
}

TEST_F(SpectrumTables, SeparatorsAreUnderstoodOrRefused) {
    EXPECT_EQ(read("nm;R\n400;0.1\n500;0.3\n")(450), 0.2);
    EXPECT_EQ(read("nm\tR\n400\t0.1\n500\t\t0.3\n")(450), 0.2);
    EXPECT_EQ(read("; a remark of 400 0.5\n400 0.1\n500 0.3\n")(400), 0.1);
    EXPECT_EQ(read("nm;R\n400;0,1\n500;0,3\n")(450), 0.2);
    EXPECT_EQ(read("400,5;0,1\n")(450), 0.1);
    EXPECT_EQ(place("nm;R\n400;0,1\n500;0.3\n", "decimal point"), (std::pair{2, 5}));
    for (const char* line : {"Scale factor,100", "YFACTOR 0.01", "scale factor 0.01"})
        EXPECT_EQ(place(std::string(line) + "\nnm,R\n400,10\n", "factor").first, 1) << line;
}

TEST_F(SpectrumTables, Case68MarksAndLineEndsOfOtherSystems) {
    const std::string lines[] = {"# c", "nm,R", "400,0.1", "500,0.3"};
    for (const std::string end : {"\n", "\r\n", "\r", "\n\f\n", "\r\n\r\n"})
        for (const std::string mark : {"", "\xef\xbb\xbf"})
            for (const std::string tail : {"", "\x1a", "\x1a\x1a\x1a", "\r\n\x1a"}) {
                std::string text = mark;
                for (const std::string& line : lines)
                    text += line + end;
                EXPECT_EQ(read(text + tail)(450), 0.2);
            }
    EXPECT_EQ(read("\f400 0.1\v\n500 0.3\f")(450), 0.2);
    EXPECT_EQ(place("nm,R\r400,0.1\r500,x\r"), (std::pair{3, 5}));
    EXPECT_EQ(place("\xef\xbb\xbf"
                    "400,x\n"),
              (std::pair{1, 5}));
    EXPECT_EQ(place("400,0.1\n\x1a\n500,0.3\n").first, 2); // in the middle it is no end
}
