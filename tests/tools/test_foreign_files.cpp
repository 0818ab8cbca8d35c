#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

namespace reradiant {

namespace {

/// Files as other programs leave them: read right, or refused by every command that reads them.
class ForeignFiles : public ProgramTest {
protected:
    nlohmann::json json_of(const std::string& arguments) const {
        const ProgramResult result = run(arguments + " --json out.json");
        EXPECT_EQ(result.exit_code, 0) << arguments << "\n" << result.errors;
        return nlohmann::json::parse(file_bytes(folder / "out.json"), nullptr, false);
    }
};

const std::string head = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                         "# kind: measured\n";
const std::string jcamp = "##TITLE= tile\n##JCAMP-DX= 4.24\n##XUNITS= 1/CM\n##YUNITS= REFLECTANCE\n"
                          "##YFACTOR= 0.01\n##FIRSTX= 16000\n##LASTX= 25000\n##NPOINTS= 4\n"
                          "##XYDATA= (X++(Y..Y))\n16000 10 20\n22000 30 40\n##END=\n";
const std::string cgats = "CGATS.17\nBEGIN_DATA_FORMAT\nSPECTRAL_NM400 SPECTRAL_NM500\n"
                          "END_DATA_FORMAT\nBEGIN_DATA\n0.25 0.75\nEND_DATA\n";
const std::string tm27 = "<IESTM2714 version=\"1.0\"><SpectralDistribution>"
                         "<SpectralData wavelength=\"400\">0.25</SpectralData>"
                         "<SpectralData wavelength=\"500\">0.75</SpectralData>"
                         "</SpectralDistribution></IESTM2714>\n";

} // namespace

TEST_F(ForeignFiles, SpectraOfOtherFormatsAreReadWhateverTheirEnding) {
    const std::pair<std::string, std::string> texts[] = {
        {".jdx", jcamp}, {".sp", cgats}, {".spdx", tm27}, {".xml", tm27}};
    for (const auto& [ending, text] : texts)
        for (const std::string& name : {"s" + ending, std::string("s.csv")}) {
            put(name, text);
            const bool is_jcamp = text == jcamp;
            for (const char* command : {"info ", "validate "}) {
                const auto json = json_of(command + name);
                EXPECT_EQ(json["kind"], "spectrum") << name;
                EXPECT_NEAR(json["highest"].get<double>(), is_jcamp ? 0.4 : 0.75, 1e-12) << name;
            }
            ASSERT_EQ(run("convert " + name + " out.csv").exit_code, 0) << name;
            const auto json = json_of("info out.csv");
            EXPECT_NEAR(json["from_nm"].get<double>(), 400, 1e-9) << name;
            EXPECT_NEAR(json["lowest"].get<double>(), is_jcamp ? 0.1 : 0.25, 1e-12) << name;
            put("scene.toml", replaced(small_scene(), "reflectance = 0.5",
                                       "reflectance = { file = \"" + name + "\" }"));
            EXPECT_EQ(run("validate scene.toml").exit_code, 0) << name;
        }
}

TEST_F(ForeignFiles, ConvertNamesTheFileThatItCannotWriteOrRead) {
    put("s.csv", "nm,value\n400,0.4\n500,0.5\n");
    const ProgramResult ending = run("convert s.csv x.txt");
    EXPECT_EQ(ending.exit_code, 2);
    EXPECT_EQ(ending.errors.find("partial"), std::string::npos) << ending.errors;
    EXPECT_NE(ending.errors.find("x.txt: a spectrum does not fit"), std::string::npos)
        << ending.errors;
    const ProgramResult nameless = run("convert \"\" x.csv");
    EXPECT_EQ(nameless.exit_code, 2);
    EXPECT_NE(nameless.errors.find("IN names no file"), std::string::npos) << nameless.errors;
}

TEST_F(ForeignFiles, MetalsAreDescribed) {
    expect_failure(2, "convert " RERADIANT_SOURCE_DIR "/spectra/metals/aluminium.csv out.csv",
                   "aluminium.csv: is a complex index of refraction");
    const auto json = json_of("info " RERADIANT_SOURCE_DIR "/spectra/metals/aluminium.csv");
    EXPECT_EQ(json["kind"], "complex index of refraction");
    EXPECT_EQ(json["from_nm"], 247.97);
    EXPECT_EQ(json["n"]["lowest"], 0.18137);
    EXPECT_GT(json["k"]["highest"], 8.0);
}

TEST_F(ForeignFiles, OnePointIsDescribedAsItIs) {
    put("s.spd", "555 0.5\n"); // a constant, whose range has no end
    for (const char* command : {"info s.spd", "validate s.spd"}) {
        const auto json = json_of(command);
        EXPECT_EQ(json["lowest"], 0.5);
        EXPECT_EQ(json["highest"], 0.5);
    }
}

TEST_F(ForeignFiles, FilesOfNoTextAreRefusedByNameEverywhere) {
    put("s.csv", "PK\x03\x04 a sheet");
    put("scene.toml",
        replaced(small_scene(), "reflectance = 0.5", "reflectance = { file = \"s.csv\" }"));
    for (const char* arguments :
         {"info s.csv", "validate s.csv", "convert s.csv out.csv", "colour s.csv",
          "fit s.csv -o out.csv", "render scene.toml -o out.exr"})
        expect_failure(2, arguments, "s.csv:1:1: the file is a Zip archive");
}

TEST_F(ForeignFiles, PercentAndGapsAreRefusedWhereverAMatrixIsRead) {
    const std::string scene =
        replaced(small_scene(), "reflectance = 0.5", "reradiation = { file = \"m.csv\" }");
    put("scene.toml", scene);
    for (const auto& [text, place] : std::initializer_list<std::pair<const char*, const char*>>{
             {"nm,400,500\n400,30,0\n500,3,40\n", "m.csv:6:5: a radiance factor of 40"},
             {"nm,400,500\n400,3,0\n500,1,4\n", "m.csv:1:1: excitation bands return 4 times"},
             {"nm,400,500\n400,0.3,0\n500,NA,0.4\n", "m.csv:7:5: 'NA' says that"},
             {"nm,400,500\n400,0.3,0\n500,,0.4\n", "m.csv:7:5: a value is missing"}}) {
        put("m.csv", head + text);
        for (const char* arguments : {"info m.csv", "validate scene.toml", "convert m.csv out.bfc",
                                      "colour m.csv", "render scene.toml -o out.exr"})
            expect_failure(2, arguments, place);
        // By itself a measurement with gaps is right: it may be fitted.
        if (std::string(place).starts_with("m.csv:7:5"))
            EXPECT_EQ(json_of("validate m.csv")["gaps"], 1);
        else
            expect_failure(2, "validate m.csv", place);
    }
    put("m.csv", "# unit: percent\n" + head + "nm,400,500\n400,30,0\n500,3,40\n");
    EXPECT_NEAR(json_of("info m.csv")["largest_radiant_column_sum"].get<double>(), 0.4, 1e-12);
}

TEST_F(ForeignFiles, PercentOfAReflectanceNamesTheRemedy) {
    put("s.csv", "nm,R\n400,30\n700,40\n");
    const std::string scene =
        replaced(small_scene(), "reflectance = 0.5", "reflectance = { file = \"s.csv\" }");
    put("scene.toml", scene);
    expect_failure(2, "validate scene.toml", "divide percent by 100");
    put("s.csv", "nm,R (%)\n400,30\n700,40\n");
    EXPECT_EQ(run("validate scene.toml").exit_code, 0);
}

TEST_F(ForeignFiles, Case68ScenesOfOtherSystems) {
    std::string carriage_returns;
    for (const char c : small_scene())
        carriage_returns += c == '\n' ? '\r' : c;
    for (const std::string& text :
         {"\xef\xbb\xbf" + small_scene(), carriage_returns, small_scene() + "\x1a\x1a"}) {
        put("scene.toml", text);
        const ProgramResult result = run("validate scene.toml");
        EXPECT_EQ(result.exit_code, 0) << result.errors;
    }
    put("scene.toml", carriage_returns + "\rwidht = 3\r");
    expect_failure(2, "validate scene.toml", "scene.toml:21:1: ");
    put("scene.toml", "[film]\n\f\nwidth = 8\n");
    expect_failure(2, "validate scene.toml", "scene.toml:2:1: ");
}

} // namespace reradiant
