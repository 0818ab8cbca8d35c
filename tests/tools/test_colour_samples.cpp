// `colour` of many samples, of measurements, and its page.
#include "tests/tools/program_runner.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include <algorithm>
#include <map>
#include <sstream>

using namespace reradiant;

namespace {

const std::string matrices = RERADIANT_SOURCE_DIR "/spectra/reradiation/";
const std::string polygons = RERADIANT_SOURCE_DIR "/spectra/polygons/en-iso-20471.csv";

using Row = std::map<std::string, std::string>;

class ColourSamples : public ProgramTest {
protected:
    void SetUp() override {
        for (const char* name : {"synthetic-orange.csv", "synthetic-green.csv", "neon-yellow.csv"})
            put(name, file_bytes(matrices + name));
    }

    nlohmann::json json(const std::string& name) const {
        return nlohmann::json::parse(file_bytes(folder / name));
    }

    /// Rows of a CSV without quoted cells, by their headings.
    std::vector<Row> table(const std::string& name) const {
        const auto cells = [](const std::string& line) {
            std::vector<std::string> result;
            std::istringstream parts(line + ',');
            for (std::string cell; std::getline(parts, cell, ',');)
                result.push_back(cell);
            return result;
        };
        std::istringstream lines(file_bytes(folder / name));
        std::string line;
        std::getline(lines, line);
        const std::vector<std::string> headings = cells(line);
        std::vector<Row> rows;
        while (std::getline(lines, line)) {
            const std::vector<std::string> values = cells(line);
            EXPECT_EQ(values.size(), headings.size()) << line;
            Row& row = rows.emplace_back();
            for (std::size_t k = 0; k < headings.size(); ++k)
                row[headings[k]] = values.at(k);
        }
        return rows;
    }
};

/// All text of a page below a node, blanks between the elements.
std::string text_of(const pugi::xml_node& node) {
    std::string text;
    for (const pugi::xml_node child : node.children())
        text +=
            child.type() == pugi::node_pcdata ? child.value() + std::string(" ") : text_of(child);
    return text;
}

} // namespace

TEST_F(ColourSamples, ARowEachHasTheNumbersOfTheSampleAlone) {
    const std::string conditions = " --illuminant D65,FL11 --observer 1931-2,1964-10 --quiet ";
    const ProgramResult seen = run("colour synthetic-orange.csv neon-yellow.csv" + conditions +
                                   "--csv all.csv --json all.json");
    ASSERT_EQ(seen.exit_code, 0) << seen.errors;
    ASSERT_EQ(run("colour neon-yellow.csv" + conditions + "--json one.json").exit_code, 0);
    const auto all = json("all.json"), one = json("one.json");
    EXPECT_EQ(all.size(), 2u);
    EXPECT_EQ(all["neon-yellow.csv"], one) << "a sample is what it is alone";
    EXPECT_EQ(one.size(), 4u);
    const std::vector<Row> rows = table("all.csv");
    ASSERT_EQ(rows.size(), 2u * 4u);
    EXPECT_EQ(std::count(seen.output.begin(), seen.output.end(), '\n'), 1 + 8) << seen.output;
    for (const Row& row : rows) {
        const auto& of = all[row.at("sample")][row.at("lamp") + "/" + row.at("observer")];
        const auto near = [&](const char* column, const nlohmann::json& value) {
            EXPECT_NEAR(std::stod(row.at(column)), value.get<double>(),
                        1e-9 * std::abs(value.get<double>()) + 1e-12)
                << column;
        };
        near("X", of["XYZ"][0]);
        near("b", of["Lab"][2]);
        near("h", of["LCh"][2]);
        near("uv_share", of["uv_share"]);
        near("uv_excluded_Y", of["uv_excluded"]["XYZ"][1]);
        EXPECT_EQ(row.at("sums"), of["sums"]);
        EXPECT_EQ(row.at("whiteness_cie").empty(), !of.contains("whiteness_cie"));
        if (of.contains("r457"))
            near("r457", of["r457"]);
        EXPECT_NE(seen.output.find(fmt::format("{:.2f}", of["Lab"][0].get<double>())),
                  std::string::npos);
    }
}

TEST_F(ColourSamples, DifferencesMetamerismAndPolygonsHaveColumns) {
    const ProgramResult seen =
        run("colour synthetic-orange.csv neon-yellow.csv --against synthetic-green.csv "
            "--illuminant D65,A --csv all.csv --json all.json --plot all.svg --polygons " +
            polygons);
    EXPECT_EQ(seen.exit_code, 0) << seen.errors;
    const std::vector<Row> rows = table("all.csv");
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_NEAR(std::stod(rows[0].at("ciede2000")),
                json("all.json")["synthetic-orange.csv"]["D65"]["ciede2000"], 1e-7);
    EXPECT_TRUE(rows[0].at("metamerism").empty());
    EXPECT_GT(std::stod(rows[1].at("metamerism")), 0.0);
    EXPECT_EQ(rows[0].at("polygons"), "fluorescent orange-red");
    EXPECT_EQ(rows[1].at("polygons"), "") << "no polygon is tested under A";
    const std::string plot = file_bytes(folder / "all.svg");
    for (const char* curve : {"D65, neon-yellow.csv", "A, synthetic-green.csv"})
        EXPECT_NE(plot.find(curve), std::string::npos) << curve;
    const ProgramResult fails =
        run("colour synthetic-orange.csv synthetic-green.csv --polygons " + polygons);
    EXPECT_EQ(fails.exit_code, 3);
    EXPECT_NE(fails.errors.find("synthetic-green.csv: the colour passes none"), std::string::npos);
    EXPECT_EQ(fails.errors.find("synthetic-orange.csv: the colour passes none"), std::string::npos);
    expect_failure(2, "colour synthetic-orange.csv --observer 1964-10 --polygons " + polygons,
                   "add 1931-2 to --observer");
}

TEST_F(ColourSamples, TableSaysAllOfEverySample) {
    const ProgramResult seen = run("colour synthetic-orange.csv synthetic-green.csv --table");
    EXPECT_NE(seen.output.find("# synthetic-green.csv\nD65\n"), std::string::npos) << seen.output;
    EXPECT_NE(seen.output.find("beta_L"), std::string::npos);
}

// Cells that need it are quoted, as RFC 4180 has it.
TEST_F(ColourSamples, NamesMayHoldCommas) {
    put("a, b.csv", file_bytes(matrices + "synthetic-green.csv"));
    ASSERT_EQ(run("colour 'a, b.csv' --csv out.csv").exit_code, 0);
    EXPECT_NE(file_bytes(folder / "out.csv").find("\n\"a, b.csv\",,D65,1931-2,bands,"),
              std::string::npos)
        << file_bytes(folder / "out.csv");
}

TEST_F(ColourSamples, MaterialsMatricesAndMeasurementsStandInOneTable) {
    const ProgramResult made = run("measure --preset neon-orange-varnished -o varnished.csv "
                                   "--theta-i 45 --theta-o 0,20 --phi 0,180");
    ASSERT_EQ(made.exit_code, 0) << made.errors;
    EXPECT_TRUE(made.output.starts_with(
        "varnished.csv: bispectral BRDF of neon-orange-varnished.toml, 4 pairs of directions, 41 "
        "bands from 300 to 700 nm, "))
        << made.output;
    ASSERT_EQ(run("colour varnished.csv synthetic-green.csv --preset neon-orange-varnished --json "
                  "out.json --csv out.csv")
                  .exit_code,
              0);
    const auto all = json("out.json");
    for (std::size_t c = 0; c < 3; ++c) // twelve digits of the file
        EXPECT_NEAR(all["varnished.csv"]["D65"]["XYZ"][c].get<double>(),
                    all["neon-orange-varnished"]["D65"]["XYZ"][c].get<double>(), 1e-8);
    EXPECT_EQ(table("out.csv")[0].at("geometry"), "45/0");
    EXPECT_EQ(table("out.csv")[1].at("geometry"), "") << "the matrix does not say it";
    ASSERT_EQ(run("colour varnished.csv --geometry 45:20:180 --json steep.json").exit_code, 0);
    EXPECT_EQ(
        run("colour synthetic-green.csv --against varnished.csv --geometry 45:20:180").exit_code, 0)
        << "the geometry is that of the reference";
    expect_failure(2, "colour varnished.csv --geometry 45:30",
                   "it holds 45:0:0, 45:0:180, 45:20:0, 45:20:180");
    expect_failure(2, "colour varnished.csv --geometry 8/d", "--hemispherical --theta-i 8");
    ASSERT_EQ(run("measure --preset neon-orange-varnished -o sphere.csv --theta-i 8 "
                  "--hemispherical --quiet")
                  .output,
              "");
    ASSERT_EQ(run("colour sphere.csv --preset neon-orange-varnished --geometry 8/d --json d.json")
                  .exit_code,
              0);
    const auto sphere = json("d.json");
    EXPECT_NEAR(sphere["sphere.csv"]["D65"]["Lab"][0].get<double>(),
                sphere["neon-orange-varnished"]["D65"]["Lab"][0].get<double>(), 1e-8);
    expect_failure(2, "colour sphere.csv --geometry 8/de", "port");
    expect_failure(2, "colour sphere.csv", "it holds 8/d");
}

TEST_F(ColourSamples, SamplesMayFollowOptions) {
    EXPECT_EQ(run("colour --illuminant D65 synthetic-orange.csv").exit_code, 0);
    EXPECT_EQ(run("colour --observer 1964-10 --illuminant D65 --illuminant A synthetic-orange.csv")
                  .exit_code,
              0);
    expect_failure(2, "colour synthetic-orange.csv --illuminant D65 A", "--illuminant D65,A");
}

TEST_F(ColourSamples, WhatIsNoSampleIsNamed) {
    put("paint.csv", "nm,value\n400,0.5\n700,0.6\n");
    put("study.toml", "[study]\nscene = \"scene.toml\"\n");
    put("index.csv", "nm,n,k\n400,1,2\n700,1,2\n");
    expect_failure(2, "colour synthetic-orange.csv " + polygons, "a file of polygons");
    expect_failure(2, "colour study.toml", "this is a study, not a sample");
    expect_failure(2, "colour index.csv", "the complex index of a metal");
    expect_failure(2, "colour paint.csv", "paint.csv: this is a spectrum, not a sample");
    expect_failure(2, "colour synthetic-orange.csv --against paint.csv", "paint.csv: ");
    expect_failure(2, "colour synthetic-orange.csv synthetic-orange.csv", "given twice");
    expect_failure(2, "colour synthetic-orange.csv missing.csv", "missing.csv: cannot be opened");
    expect_failure(2, "colour synthetic-orange.csv synthetic-green.csv --geometry 8/d",
                   "--geometry is for materials");
    expect_failure(2, "colour --preset fluorescent-orange-smooth --geometry 20",
                   "8/d, d/8 (specular included)");
    expect_failure(2, "colour --preset fluorescent-orange-smooth --geometry 95:0",
                   "below the horizon");
    expect_failure(2, "colour --preset fluorescent-orange-smooth --geometry 0:180",
                   "of what is reflected");
}

TEST_F(ColourSamples, OutputsAreCheckedBeforeWorkBegins) {
    const std::string orange = "colour synthetic-orange.csv ";
    expect_failure(2, orange + "--csv nowhere/out.csv", "nowhere");
    expect_failure(2, orange + "--csv out.html", "use --report out.html");
    expect_failure(2, orange + "--report out.csv", "use --csv out.csv");
    expect_failure(2, orange + "--report nowhere/out.html", "nowhere");
    expect_failure(2, orange + "--csv synthetic-orange.csv", "write over what is read");
    expect_failure(2, orange + "--csv a.csv --json b.json --plot nowhere/c.svg", "nowhere");
    expect_failure(1, orange + "--csv /dev/full", "/dev/full");
    expect_failure(1, orange + "--report /dev/full", "/dev/full");
}

TEST_F(ColourSamples, LampsThatAreAllButDarkAreWarnedOf) {
    const ProgramResult line = run("colour synthetic-orange.csv --illuminant L:365");
    EXPECT_EQ(line.exit_code, 0);
    EXPECT_NE(line.errors.find("D65+30*L:365"), std::string::npos) << line.errors;
    EXPECT_EQ(line.output.find("nan at"), std::string::npos) << line.output;
    const ProgramResult sum = run("colour synthetic-orange.csv --illuminant D65+30*L:365");
    EXPECT_EQ(sum.errors, "");
    put("blue.csv", "nm,value\n300,1\n480,1\n");
    const ProgramResult ends = run("colour synthetic-orange.csv --lamp blue.csv");
    EXPECT_NE(ends.errors.find("blue.csv ends at 480 nm"), std::string::npos) << ends.errors;
}

TEST_F(ColourSamples, ThePageIsWellFormedAndHoldsTheNumbersOfEachLamp) {
    put("odd <&> \"name\".csv", file_bytes(matrices + "synthetic-green.csv"));
    const ProgramResult seen =
        run("colour synthetic-orange.csv 'odd <&> \"name\".csv' --against neon-yellow.csv "
            "--illuminant D65,FL11,D65+20*L:365 --observer 1931-2,1964-10 --quiet --report "
            "page.html --json all.json --polygons " +
            polygons);
    EXPECT_EQ(seen.exit_code, 3) << seen.errors;
    pugi::xml_document page;
    const pugi::xml_parse_result parsed =
        page.load_file((folder / "page.html").c_str(), pugi::parse_default | pugi::parse_doctype);
    ASSERT_TRUE(parsed) << parsed.description() << " at " << parsed.offset;
    const pugi::xml_node body = page.child("html").child("body");
    const std::string text = text_of(body);
    const auto all = json("all.json");
    for (const auto& [sample, reports] : all.items()) {
        EXPECT_NE(text.find(sample), std::string::npos) << sample;
        for (const auto& [key, report] : reports.items())
            for (const double value :
                 {report["Lab"][0].get<double>(), report["XYZ"][1].get<double>(),
                  report["uv_excluded"]["Lab"][2].get<double>(),
                  report["delta_e"]["cmc21"].get<double>()})
                EXPECT_NE(text.find(fmt::format(" {:.2f} ", value)), std::string::npos)
                    << sample << ' ' << key << ' ' << value;
    }
    for (const char* part : {"fluorescent orange-red", "observer 1964-10", "+ white of the lamp",
                             "D65+20*L:365 luminescent, synthetic-orange.csv", "starts at 380 nm"})
        EXPECT_NE(text.find(part), std::string::npos) << part;
    // Swatches: two observers, two samples, three lamps, halves.
    EXPECT_EQ(page.select_nodes("//rect/title").size(), 2u * 2u * 3u * 2u);
    EXPECT_EQ(page.select_nodes("//svg").size(), 2u + 2u + 2u);
    const std::string bytes = file_bytes(folder / "page.html");
    for (const char* fetched : {"src=", "href=", "<script", "@import", "url("})
        EXPECT_EQ(bytes.find(fetched), std::string::npos) << fetched;
}

// A grey of 18 % is #767676 (118) in sRGB under any lamp, and white is white.
TEST_F(ColourSamples, SwatchesAreWhatAScreenShows) {
    std::string grey = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\nnm";
    for (int nm = 380; nm <= 780; nm += 10)
        grey += fmt::format(",{}", nm);
    std::string white = grey;
    for (int o = 380; o <= 780; o += 10) {
        grey += fmt::format("\n{}", o);
        white += fmt::format("\n{}", o);
        for (int i = 380; i <= 780; i += 10) {
            grey += i == o ? ",0.18" : ",0";
            white += i == o ? ",1" : ",0";
        }
    }
    put("grey.csv", grey + "\n");
    put("white.csv", white + "\n");
    ASSERT_EQ(run("colour grey.csv white.csv --illuminant D65,A,FL11 --observer 1931-2,2015-10 "
                  "--report page.html")
                  .exit_code,
              0);
    const std::string page = file_bytes(folder / "page.html");
    const auto count = [&](const std::string& text) {
        int found = 0;
        for (std::size_t at = 0; (at = page.find(text, at)) != std::string::npos; ++at)
            ++found;
        return found;
    };
    EXPECT_EQ(count("fill=\"#767676\"><title>"), 6);
    EXPECT_EQ(count("fill=\"#ffffff\"><title>"), 6);
    EXPECT_EQ(count("h-11l11 11z"), 0) << "nothing is beyond the screen";
}
