#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

using namespace reradiant;

namespace {

const std::string examples = RERADIANT_SOURCE_DIR "/tools/examples/";
const std::string matrices = RERADIANT_SOURCE_DIR "/spectra/reradiation/";
const std::string polygons = RERADIANT_SOURCE_DIR "/spectra/polygons/en-iso-20471.csv";

class SynthAndColour : public ProgramTest {
protected:
    nlohmann::json json(const std::string& name) const {
        return nlohmann::json::parse(file_bytes(folder / name));
    }
};

} // namespace

TEST_F(SynthAndColour, SynthWritesDataThatColourReads) {
    const ProgramResult made = run("synth " + examples +
                                   "synth-orange.toml -o data.csv --truth truth.csv --seed 3 "
                                   "--json synth.json");
    ASSERT_EQ(made.exit_code, 0) << made.errors;
    EXPECT_NE(made.output.find("2009 entries"), std::string::npos) << made.output;
    EXPECT_NE(file_bytes(folder / "data.csv").find("# kind: measured"), std::string::npos);
    EXPECT_NE(file_bytes(folder / "truth.csv").find("# kind: model"), std::string::npos);
    EXPECT_EQ(json("synth.json")["seed"], 3);
    EXPECT_GT(json("synth.json")["noise_rms"], 0.0);
    const ProgramResult seen =
        run("colour data.csv --against truth.csv --illuminant D65,FL2 --json colour.json "
            "--plot factors.svg --polygons " +
            polygons);
    ASSERT_EQ(seen.exit_code, 0) << seen.output << seen.errors;
    const auto colour = json("colour.json");
    EXPECT_EQ(colour["D65"]["beta_T"].size(), 41u);
    EXPECT_EQ(colour["D65"]["xy"].size(), 2u);
    EXPECT_EQ(colour["D65"]["Lab"].size(), 3u);
    EXPECT_TRUE(colour["D65"].contains("whiteness"));
    EXPECT_FALSE(colour["FL2"].contains("whiteness"));
    EXPECT_EQ(colour["D65"]["polygons"][1]["name"], "fluorescent orange-red");
    // Noise of 0.7 % of the peak, bandpass and spill move the colour little, and not by nothing.
    EXPECT_GT(colour["D65"]["ciede2000"], 1e-3);
    EXPECT_LT(colour["D65"]["ciede2000"], 5.0);
    EXPECT_NE(seen.errors.find("380 nm"), std::string::npos) << seen.errors;
    EXPECT_EQ(file_bytes(folder / "factors.svg").substr(0, 4), "<svg");
}

TEST_F(SynthAndColour, LayeredDataCarryStandardErrors) {
    const ProgramResult made = run("synth " + examples + "synth-varnished.toml -o data.csv");
    ASSERT_EQ(made.exit_code, 0) << made.errors;
    const std::string text = file_bytes(folder / "data.csv");
    EXPECT_NE(text.find("lambda_o_nm,value,stderr,part"), std::string::npos);
    EXPECT_NE(text.find(",diffuse"), std::string::npos);
    EXPECT_EQ(text.find(",nan,"), std::string::npos);
    ASSERT_EQ(run("synth " + examples + "synth-varnished.toml -o again.csv").exit_code, 0);
    EXPECT_EQ(text, file_bytes(folder / "again.csv"));
    ASSERT_EQ(run("synth " + examples + "synth-varnished.toml -o other.csv --seed 2").exit_code, 0);
    EXPECT_NE(text, file_bytes(folder / "other.csv"));
}

TEST_F(SynthAndColour, LampsWithLinesAreSummedOverNanometresAndSaySo) {
    const std::string command =
        "colour " + matrices + "synthetic-orange.csv --illuminant FL11,D65 ";
    const ProgramResult seen = run(command + "--json out.json");
    ASSERT_EQ(seen.exit_code, 0) << seen.errors;
    EXPECT_NE(seen.output.find("FL11\n  summed over 1 nm: "), std::string::npos) << seen.output;
    EXPECT_EQ(seen.output.find("D65\n  summed"), std::string::npos) << seen.output;
    const auto both = json("out.json");
    EXPECT_EQ(both["FL11"]["sums"], "1 nm");
    EXPECT_EQ(both["D65"]["sums"], "bands");
    ASSERT_EQ(run(command + "--plain-sums --json plain.json").exit_code, 0);
    ASSERT_EQ(run(command + "--e308 --json fine.json").exit_code, 0);
    EXPECT_EQ(both["FL11"]["XYZ"], json("fine.json")["FL11"]["XYZ"]);
    EXPECT_NE(both["FL11"]["XYZ"], json("plain.json")["FL11"]["XYZ"]);
    EXPECT_EQ(both["D65"]["XYZ"], json("plain.json")["D65"]["XYZ"]);
    expect_failure(2, command + "--plain-sums --e308", "--plain-sums");
}

TEST_F(SynthAndColour, QuietSilencesWarningsAndNotTheColour) {
    const std::string command = "colour " + matrices + "synthetic-orange.csv --illuminant D65,FL2";
    const ProgramResult seen = run(command), quiet = run(command + " --quiet");
    EXPECT_EQ(quiet.exit_code, 0);
    EXPECT_NE(quiet.output.find("  XYZ  "), std::string::npos) << quiet.output;
    EXPECT_EQ(quiet.output, seen.output);
    EXPECT_TRUE(quiet.errors.empty()) << quiet.errors;
}

TEST_F(SynthAndColour, TheTableOfWavelengthsIsPrintedWhenAskedFor) {
    const std::string command = "colour " + matrices + "synthetic-orange.csv";
    const std::string plain = run(command).output, table = run(command + " --table").output;
    EXPECT_EQ(plain.find("beta_R"), std::string::npos) << plain;
    EXPECT_TRUE(table.starts_with(plain)) << table;
    // Its head, and the matrix's 49 emission bands.
    const std::string rest = table.substr(plain.size());
    EXPECT_EQ(std::count(rest.begin(), rest.end(), '\n'), 50) << rest;
}

TEST_F(SynthAndColour, ThePlotShowsBothMatrices) {
    const std::string orange = matrices + "synthetic-orange.csv";
    put("other.csv", file_bytes(orange));
    ASSERT_EQ(run("colour " + orange + " --plot one.svg").exit_code, 0);
    ASSERT_EQ(run("colour " + orange + " --against other.csv --plot two.svg").exit_code, 0);
    const std::string one = file_bytes(folder / "one.svg"), two = file_bytes(folder / "two.svg");
    const auto curves = [](const std::string& svg) {
        std::size_t count = 0;
        for (std::size_t at = 0; (at = svg.find("stroke-width=\"1.8\"", at)) != std::string::npos;
             ++at)
            ++count;
        return count;
    };
    EXPECT_EQ(one.find("other.csv"), std::string::npos);
    for (const char* name :
         {"D65 total, synthetic-orange.csv", "D65 total, other.csv", "reflected, other.csv"})
        EXPECT_NE(two.find(name), std::string::npos) << name;
    EXPECT_EQ(curves(two), 2 * curves(one));
}

TEST_F(SynthAndColour, NoPolygonThatPassesIsExitThree) {
    put("blue.csv", "name,illuminant,minimum_luminance_factor,corners\n"
                    "blue,D65,0.1,0.14,0.05,0.2,0.1,0.2,0.2,0.1,0.2\n");
    const ProgramResult seen =
        run("colour " + matrices + "synthetic-orange.csv --polygons blue.csv --json out.json");
    EXPECT_EQ(seen.exit_code, 3);
    EXPECT_NE(seen.errors.find("none of the polygons"), std::string::npos) << seen.errors;
    EXPECT_EQ(json("out.json")["D65"]["polygons"][0]["passes"], false);
}

TEST_F(SynthAndColour, BadInputIsExitTwoAtItsPlace) {
    put("bad.toml", "reflectance = 2\n");
    put("bad.csv", "# reradiation\n# quantity: per-band\nnm,500,510\n");
    expect_failure(2, "synth bad.toml -o data.csv", "bad.toml:1:1: ");
    expect_failure(2, "synth missing.toml -o data.csv", "missing.toml: ");
    expect_failure(2, "synth " + examples + "synth-orange.toml", "--output");
    expect_failure(2, "synth " + examples + "synth-orange.toml -o data.bfc", "data.bfc: ");
    expect_failure(2, "synth " + examples + "synth-orange.toml -o data.csv --truth truth.txt",
                   "truth.txt: ");
    expect_failure(2, "synth " + examples + "synth-orange.toml -o nowhere/data.csv", "nowhere");
    expect_failure(2, "colour bad.csv", "bad.csv:3:1: ");
    const std::string orange = "colour " + matrices + "synthetic-orange.csv ";
    expect_failure(2, orange + "--illuminant D66", "there is no illuminant 'D66'");
    expect_failure(2, orange + "--illuminant A --polygons " + polygons, "en-iso-20471.csv:9:1: ");
    expect_failure(2, orange + "--against missing.csv", "missing.csv: ");
}

TEST_F(SynthAndColour, Case53FullDiskIsExitOne) {
    expect_failure(1, "colour " + matrices + "synthetic-orange.csv --json /dev/full", "/dev/full");
}

TEST_F(SynthAndColour, AnEmptyNameOfAnIlluminantIsRefused) {
    for (const char* names : {"D65,,A", "D65,", ",A", "\"\""}) {
        const ProgramResult result =
            run("colour " + matrices + "synthetic-orange.csv --illuminant " + names);
        EXPECT_EQ(result.exit_code, 2) << names;
        EXPECT_NE(result.errors.find("a name is missing"), std::string::npos) << result.errors;
    }
}

TEST_F(SynthAndColour, LampsObserversAndIndicesHaveTheirKeys) {
    const std::string orange = "colour " + matrices + "synthetic-orange.csv ";
    put("lamp.csv", "nm,value\n300,1\n830,1\n");
    ASSERT_EQ(run(orange +
                  "--illuminant D65,D:5000,M2,D65+20*L:365 --lamp lamp.csv "
                  "--observer 1931-2,1964-10 --against " +
                  matrices + "synthetic-green.csv --json out.json")
                  .exit_code,
              0);
    const auto all = json("out.json");
    EXPECT_EQ(all.size(), 10u);
    const auto& d65 = all["D65/1964-10"];
    for (const char* key : {"XYZ", "xy", "Lab", "LCh", "whiteness_cie", "tint_cie", "r457",
                            "whiteness_e313", "yellowness_e313"}) {
        EXPECT_TRUE(d65.contains(key)) << key;
        EXPECT_TRUE(d65["uv_excluded"].contains(key)) << key;
    }
    for (const char* key : {"cie1976", "cie1994", "ciede2000", "cmc21"})
        EXPECT_GT(d65["delta_e"][key], 1.0) << key;
    EXPECT_EQ(all["D65+20*L:365/1931-2"]["sums"], "1 nm");
    EXPECT_GT(all["D65+20*L:365/1931-2"]["uv_share"], d65["uv_share"]);
    EXPECT_FALSE(all["D:5000/1931-2"].contains("whiteness_cie"));
    EXPECT_FALSE(d65.contains("metamerism"));
    EXPECT_GT(all["M2/1931-2"]["metamerism"], 0.0);
    // Without ultraviolet light from the start nothing is left to exclude.
    ASSERT_EQ(run(orange + "--uv-cut 420 --json cut.json").exit_code, 0);
    const auto cut = json("cut.json")["D65"];
    EXPECT_EQ(cut["XYZ"], cut["uv_excluded"]["XYZ"]);
    EXPECT_EQ(cut["uv_share"], 0.0);
}

TEST_F(SynthAndColour, MaterialsAreSeenInAGeometry) {
    ASSERT_EQ(
        run("colour --preset fluorescent-orange-smooth --geometry 8/d --json in.json").exit_code,
        0);
    ASSERT_EQ(
        run("colour --preset fluorescent-orange-smooth --geometry 8/de --json out.json").exit_code,
        0);
    // The mirror of the coat adds the same to X, Y and Z of a white: some 4 %.
    const double more = json("in.json")["D65"]["XYZ"][1].get<double>() -
                        json("out.json")["D65"]["XYZ"][1].get<double>();
    EXPECT_NEAR(more, 4.0, 0.5);
    expect_failure(2, "colour --preset fluorescent-orange-smooth --geometry 95:0", "--geometry: ");
    expect_failure(2, "colour " + matrices + "synthetic-orange.csv --geometry 8/d",
                   "synthetic-orange.csv: ");
    expect_failure(2, "colour", "MATERIAL.toml");
    expect_failure(2, "colour --preset nothing", "'nothing'");
}

TEST_F(SynthAndColour, BadLampsAndObserversNameTheirOption) {
    const std::string orange = "colour " + matrices + "synthetic-orange.csv ";
    put("negative.csv", "nm,value\n400,1\n500,-1\n700,1\n");
    expect_failure(2, orange + "--illuminant D:300", "--illuminant: ");
    expect_failure(2, orange + "--illuminant D65,D65", "asked for twice");
    expect_failure(2, orange + "--observer 2", "--observer: ");
    expect_failure(2, orange + "--uv-cut 20", "--uv-cut: ");
    expect_failure(2, orange + "--lamp negative.csv", "negative.csv: the lamp is negative");
    expect_failure(2, orange + "--lamp missing.csv", "missing.csv: ");
}
