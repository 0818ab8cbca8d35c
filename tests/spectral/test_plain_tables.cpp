#include "host/spectral/evidence/undeclared_table.h"
#include "reradiant/spectral_files.h"
#include "tests/spectral/refusal.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>

using namespace reradiant;

namespace {

/// Tables of numbers as spreadsheets and instruments export them, without a word of what they are.
class PlainTables : public test::ScratchFolder {
protected:
    ReradiationMatrix read(const std::string& text, const TableWords& words) const {
        return read_reradiation(write("m.csv", text), Gaps::Refused, table_form(words));
    }
    std::pair<int, int> refused(const std::string& text, const std::string& words,
                                const TableWords& told = {}) const {
        return refusal([&] { read(text, told); }, words);
    }
    void expect_same(const std::string& text, const TableWords& words) const {
        const ReradiationMatrix matrix = read(text, words);
        const ReradiationMatrix right = read("# quantity: per-band\n# orientation: rows-emission\n"
                                             "# kind: measured\n" +
                                                 points,
                                             {});
        EXPECT_EQ(matrix.emission, right.emission) << text;
        EXPECT_EQ(matrix.excitation, right.excitation) << text;
        EXPECT_LT((matrix.values - right.values).cwiseAbs().maxCoeff(), 1e-15) << text;
    }
    const std::string points =
        "nm,400,410,420\n400,0.25,0,0\n410,0.02,0.5,0\n420,0.125,0.03,0.75\n";
    const TableWords rows_emission{.rows = "emission", .quantity = "per-band"};
    const std::string declared = "# quantity: per-band\n# orientation: rows-emission\n";
};

} // namespace

TEST_F(PlainTables, DecimalCommasAreReadWhereTheyCanBeNothingElse) {
    std::string semicolons =
        "nm;400;410;420\n400;0,25;0;0\n410;0,02;0,5;0\n420;0,125;3,0E-2;0,75\n";
    std::string tabs = semicolons, blanks = semicolons;
    std::replace(tabs.begin(), tabs.end(), ';', '\t');
    std::replace(blanks.begin(), blanks.end(), ';', ' ');
    const std::string quoted = "nm,400,410,420\n400,\"0,25\",0,0\n410,\"0,02\",\"0,5\",0\n"
                               "420,\"0,125\",\"0,03\",\"0,75\"\n";
    for (const std::string& text : {semicolons, tabs, blanks, quoted, points}) {
        expect_same(text, rows_emission);
        expect_same(declared + text, {});
        expect_same("\xef\xbb\xbf" + text, rows_emission);
    }
    // A title's point is of a version, and its comma of a slit.
    expect_same("Export 2.1\nSlit;2,5\n\n" + semicolons, rows_emission);
}

TEST_F(PlainTables, DoubtfulCommasAreRefusedWithWhatSettlesThem) {
    const std::string mixed = "nm;400;410\n400;0,25;0\n410;0.02;0,5\n";
    EXPECT_EQ(refused(declared + mixed, "'0.02' in line 5 has a decimal point"), (std::pair{4, 5}));
    const std::string thousands = "nm;400;410\n400;1,234;0\n410;1,025;1,500\n";
    EXPECT_EQ(refused(declared + thousands, "part thousands"), (std::pair{4, 5}));
    EXPECT_EQ(read(declared + thousands, {.scale = "percent", .decimal = "comma"}).values(0, 0),
              0.01234);
    EXPECT_EQ(refused(declared + "nm;400;410\n400;0,25;0\n410;0,02;0,5\n", "'0,25' is not a number",
                      {.decimal = "point"}),
              (std::pair{4, 5}));
    EXPECT_EQ(refused(declared + "nm;400;410\n400;0.25;0\n410;0.02;0.5\n",
                      "'0.25' has a decimal point", {.decimal = "comma"}),
              (std::pair{4, 5}));
    EXPECT_EQ(refused("nm,400,410\n400,25,0\n", "commas separate the cells",
                      {.rows = "emission", .quantity = "per-band", .decimal = "comma"}),
              (std::pair{2, 1}));
}

TEST_F(PlainTables, SpectraHaveDecimalCommasToo) {
    for (const char* text : {"400;0,4\n500;0,5\n", "400\t0,4\n500\t0,5\n", "400 0,4\n500 0,5\n",
                             "nm;value\n400,5;0,4\n500;0,5\n", "400,\"0,4\"\n500,\"0,5\"\n"})
        EXPECT_EQ(read_spectrum(write("s.csv", text))(500.0), 0.5) << text;
}

TEST_F(PlainTables, EveryOrientationQuantityAndScaleIsRead) {
    const std::string transposed =
        "nm,400,410,420\n400,0.25,0.02,0.125\n410,0,0.5,0.03\n420,0,0,0.75\n";
    const std::string density =
        "nm,400,410,420\n400,0.25,0,0\n410,0.002,0.5,0\n420,0.0125,0.003,0.75\n";
    const std::string percent = "nm,400,410,420\n400,25,0,0\n410,2,50,0\n420,12.5,3,75\n";
    const std::string signs = "nm,400,410,420\n400,25%,0%,0\n410,2 %,50%,0\n420,12.5%,3%,75%\n";
    expect_same(transposed, {.rows = "excitation", .quantity = "per-band"});
    expect_same(density, {.rows = "emission", .quantity = "density"});
    expect_same(density, {.rows = "rows-emission", .quantity = "density-per-nm"});
    expect_same(percent, {.rows = "emission", .quantity = "per-band", .scale = "percent"});
    expect_same(percent, {.rows = "emission", .quantity = "per-band", .scale = "0.01"});
    expect_same(signs, rows_emission);
    EXPECT_EQ(refused("nm,400,410\n400,25%,0\n410,2%,50\n", "no percent sign", rows_emission),
              (std::pair{3, 8}));
    for (const char* scale : {"0", "-1", "per-cent", "nan", "1e"})
        refusal([&] { table_form({.scale = scale}); }, "scale");
}

TEST_F(PlainTables, CornersAndTitlesOfAnyProgramAreRead) {
    const std::string body = points.substr(points.find(','));
    for (const char* corner : {"", "em\\ex", "0", "NaN", "Emission / Excitation", "\"em (nm)\""})
        expect_same(corner + body, rows_emission);
    expect_same(body.substr(1), rows_emission); // R leaves the corner out
    expect_same("Sample 7,Orange\nDate,2024-03-01,10:15\nIntegration time,0.5\n\n" + points,
                rows_emission);
    EXPECT_EQ(refused("pixel" + body, "not a wavelength", rows_emission), (std::pair{1, 1}));
    EXPECT_EQ(refused("400,0.25,0\n410,0.02,0.5\n", "headings is missing", rows_emission),
              (std::pair{1, 1}));
}

TEST_F(PlainTables, TheLongFormHasManySpellings) {
    const std::string lines = "400;400;0,25\n400;410;0,02\n400;420;0,125\n410;410;0,5\n"
                              "410;420;0,03\n420;420;0,75\n";
    for (const char* headings :
         {"excitation_nm;emission_nm;value", "Ex (nm);Em (nm);Value", "Excitation;Emission;Values",
          "excitation wavelength [nm];emission wavelength [nm];radiance factor"})
        expect_same(headings + ("\n" + lines), rows_emission);
    EXPECT_EQ(refused("Ex;Em;Value\n" + lines, "--rows emission --quantity per-band"),
              (std::pair{1, 1}));
}

TEST_F(PlainTables, WhatTheFileSaysBeatsNothingSilently) {
    EXPECT_EQ(refused(declared + points, "'orientation' contradicts", {.rows = "excitation"}),
              (std::pair{2, 3}));
    EXPECT_EQ(refused(declared + points, "'quantity' contradicts", {.quantity = "density"}),
              (std::pair{1, 3}));
    EXPECT_EQ(refused("# kind: model\n" + declared + points, "'kind'", {.kind = "measured"}),
              (std::pair{1, 3}));
    EXPECT_EQ(refused("# anti-stokes: refused\n" + declared + points, "'anti-stokes'",
                      {.anti_stokes = true}),
              (std::pair{1, 3}));
    EXPECT_EQ(refused("# unit: percent\n" + declared + points, "scales its values by 0.01",
                      {.scale = "permille"}),
              (std::pair{1, 3}));
    EXPECT_EQ(refused("# factor: 0.5\n" + declared + points, "--scale 0.5"), (std::pair{1, 3}));
    expect_same(declared + points, rows_emission); // agreement is none
    EXPECT_EQ(read("# factor: 0.5\n" + declared + points, {.scale = "0.5"}).values(0, 0), 0.125);
}

TEST_F(PlainTables, GapsBelowTheExcitationAreZeroAndElsewhereRefused) {
    expect_same("nm,400,410,420\n400,0.25,,\n410,0.02,0.5,nan\n420,0.125,0.03,0.75\n",
                rows_emission);
    EXPECT_EQ(refused("nm,400,410\n400,0.25,0\n410,,0.5\n", "a value is missing", rows_emission),
              (std::pair{3, 5}));
    EXPECT_EQ(refused("nm,400,410\n400,0.25,\n410,0.1,0.5\n", "a value is missing",
                      {.rows = "emission", .quantity = "per-band", .anti_stokes = true}),
              (std::pair{2, 10}));
}

TEST_F(PlainTables, AKeyThatIsNearlyRightNamesTheRightOne) {
    for (const auto& [line, key] : std::initializer_list<std::pair<const char*, const char*>>{
             {"# anti_stokes_allowed: yes", "anti-stokes"},
             {"# antistokes: allowed", "anti-stokes"},
             {"# AntiStokes = allowed", "anti-stokes"},
             {"# anti stokes emission: allowed", "anti-stokes"},
             {"# orientaton: rows-emission", "orientation"},
             {"# orientations: rows-emission", "orientation"},
             {"# quantitiy: per-band", "quantity"},
             {"# qantity: per-band", "quantity"},
             {"# kinds: measured", "kind"},
             {"# geometri: 45/0", "geometry"},
             {"# emission-step: 10", "emission-step-nm"}})
        EXPECT_EQ(
            refused(line + ("\n" + declared) + points, "did you mean '" + std::string(key) + "'"),
            (std::pair{1, 3}))
            << line;
    EXPECT_EQ(refused("# rows: excitation\n" + points, "write '# orientation: rows-excitation'"),
              (std::pair{1, 3}));
    EXPECT_EQ(refused("# scale: percent\n" + declared + points, "write '# unit: percent'"),
              (std::pair{1, 3}));
    EXPECT_EQ(refused("quantity: per-band\n" + points, "write '# quantity: per-band'"),
              (std::pair{1, 1}));
    EXPECT_EQ(refused("# kind measured\n" + declared + points, "write '# kind: measured'"),
              (std::pair{1, 1}));
    EXPECT_EQ(refused("#quantity;per-band\n" + points, "write '# quantity: per-band'"),
              (std::pair{1, 1}));
    // Remarks stay remarks.
    expect_same("# operator: me\n# quality: good\n# date = today\n# kind of paint: orange\n# a "
                "measured sample\n# kind: measured\n" +
                    declared + points,
                {});
}

TEST_F(PlainTables, AnUndeclaredTableIsToldTheCommandThatDeclaresIt) {
    // A dye that sends half of the photons at 400 nm to 430 and 440 nm.
    const std::string percent =
        "em\\ex;400;410;420;430;440\n400;25,0;0;0;0;0\n410;0;50,0;0;0;0\n"
        "420;0;0;75,0;0;0\n430;30,0;20,0;0;80,0;0\n440;20,0;9,5;0,5;0;90,0\n";
    const auto at = refused(percent, "--rows emission --quantity per-band --scale percent");
    EXPECT_EQ(at, (std::pair{1, 1}));
    refused(percent, "100 % of the fluorescence would be anti-Stokes if rows were excitation");
    refused(percent, "values up to 90 are probably percent");
    refused(percent, "add above the table '# quantity: per-band', '# orientation: rows-emission', "
                     "'# unit: percent'");
    refused(percent, "the orientation of the table is not declared", {.quantity = "per-band"});
    // Nothing speaks for either orientation of this table: the user is given the choice.
    refused("nm,400,410\n400,0.3,0\n410,0,0.4\n", "'--rows excitation' where");
    EXPECT_TRUE(holds_reradiation(write("m.csv", percent)));
    EXPECT_EQ(refusal([&] { read_spectrum(write("m.csv", percent)); }, "re-radiation matrix"),
              (std::pair{1, 1}));
    EXPECT_EQ(refusal([&] { read_reradiation(write("it's mine.csv", percent)); }, "it'\\''s mine"),
              (std::pair{1, 1}));
    // Spectra of many samples and of wavelengths down the table are none.
    for (const char* text : {"nm,1,2,3\n400,0.1,0.2,0.3\n", "sample,400,410,420\nred,0.1,0.2,0.3\n",
                             "400 0.1\n410 0.2\n"})
        EXPECT_FALSE(holds_reradiation(write("s.csv", text))) << text;
}

TEST_F(PlainTables, DatesAndNumbersAboveTheTableAreTitles) {
    const std::string sheet = "nm;400;410;420\n400;0,25;0;0\n410;0,02;0,5;0\n420;0,125;0,03;0,75\n";
    for (const char* title : {"28.06.1999", "28.06.1999;13:57;1", "2026-06-28;Sample 3", "13:57",
                              "28.06.1999;;;", "6/28/99"})
        expect_same(std::string(title) + "\n" + sheet, rows_emission);
    // An empty cell behind the last number separates nothing.
    const std::string spectrum = "400,0\t\n500,5\t\n";
    EXPECT_EQ(read_spectrum(write("s.csv", spectrum))(500.0), 5.0);
}

TEST_F(PlainTables, PercentBecomesTheNearestNumber) {
    const std::string percent = "nm,400,410\n400,47.1,0\n410,0.47,58\n";
    TableWords words = rows_emission;
    words.scale = "percent";
    EXPECT_EQ(read(percent, words).values(1, 0), 0.0047);
    words.scale = "permille";
    EXPECT_EQ(read(percent, words).values(1, 0), 0.00047);
}

TEST_F(PlainTables, TheLongFormNeedsNoOrientationAndMayStateItsUnit) {
    const std::string text = "Excitation (nm);Emission (nm);Value (%)\n400;400;25\n400;410;2\n"
                             "400;420;12,5\n410;410;50\n410;420;3\n420;420;75\n410;400;0\n"
                             "420;400;0\n420;410;0\n";
    expect_same(text, {.quantity = "per-band"});
    refused(text, "the quantity of the table is not declared");
}

TEST_F(PlainTables, WhatTheProposedCommandWouldRefuseIsSaidAtOnce) {
    refused("nm,400,410,420\n400,0,25,0,0,0,0\n410,0,02,0,5,0,0\n420,0,12,0,03,0,75\n",
            "save the sheet with semicolons or tabs");
    // The options that the user gave already are part of the proposal.
    TableWords words{.scale = "0.01"};
    words.anti_stokes = true;
    words.geometry = "45/0";
    refused(points, "--scale 0.01 --anti-stokes --geometry 45/0", words);
}
