#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>
#include <vector>

namespace reradiant {

namespace {

using Rows = std::vector<std::vector<std::string>>;

/// A matrix on its way from a spreadsheet to a colour, a picture and a fit.
class OwnMatrix : public ProgramTest {
protected:
    /// Cells of the shipped orange, headings first, rows = emission, without its '#' lines.
    static Rows orange() {
        std::istringstream text(
            file_bytes(RERADIANT_SOURCE_DIR "/spectra/reradiation/synthetic-orange.csv"));
        Rows rows;
        for (std::string line; std::getline(text, line);) {
            if (line.starts_with('#'))
                continue;
            std::istringstream cells(line);
            rows.emplace_back();
            for (std::string cell; std::getline(cells, cell, ',');)
                rows.back().push_back(cell);
        }
        return rows;
    }
    static Rows transposed(const Rows& rows) {
        Rows result(rows[0].size(), std::vector<std::string>(rows.size()));
        for (std::size_t r = 0; r < rows.size(); ++r)
            for (std::size_t c = 0; c < rows[r].size(); ++c)
                result[c][r] = rows[r][c];
        return result;
    }
    /// Values (not wavelengths) times a factor; of those off the diagonal only if told.
    static Rows multiplied(Rows rows, double factor, bool off_diagonal_only = false) {
        for (std::size_t r = 1; r < rows.size(); ++r)
            for (std::size_t c = 1; c < rows[r].size(); ++c)
                if (!off_diagonal_only || rows[r][0] != rows[0][c])
                    rows[r][c] = std::to_string(factor * std::stod(rows[r][c]));
        return rows;
    }
    static std::string joined(const Rows& rows, const std::string& separator) {
        std::string text;
        for (const auto& row : rows) {
            for (std::size_t c = 0; c < row.size(); ++c)
                text += (c > 0 ? separator : "") + row[c];
            text += '\n';
        }
        return text;
    }
    static std::string as_german_sheet(Rows rows) {
        rows[0][0] = "";
        std::string text = joined(rows, ";");
        std::replace(text.begin(), text.end(), '.', ',');
        return text;
    }
    /// Arguments of the command between back quotes in an error.
    static std::string proposed(const std::string& errors) {
        const std::string mark = "`reradiant ";
        const auto from = errors.find(mark);
        if (from == std::string::npos)
            return "";
        return errors.substr(from + mark.size(), errors.find('`', from + 1) - from - mark.size());
    }
    nlohmann::json json_of(const std::string& arguments) const {
        const ProgramResult result = run(arguments + " --json out.json");
        EXPECT_EQ(result.exit_code, 0) << arguments << "\n" << result.errors;
        return nlohmann::json::parse(file_bytes(folder / "out.json"), nullptr, false);
    }
    /// One line of every command that reads the matrix warns in these words.
    void expect_warned(const std::string& text, const std::string& words) const {
        put("m.csv", text);
        for (const char* arguments :
             {"colour m.csv", "info m.csv", "validate m.csv", "convert m.csv converted.csv",
              "fit m.csv -o fitted.csv --rank 1"}) {
            const ProgramResult result = run(arguments);
            EXPECT_NE(result.errors.find(words), std::string::npos)
                << arguments << "\n"
                << result.errors << "lacks " << words;
        }
    }
    const std::string declared = "# quantity: per-band\n# orientation: rows-emission\n";
    const std::string measured = "# kind: measured\n" + declared;
};

} // namespace

TEST_F(OwnMatrix, EveryReaderProposesTheCommandThatReadsIt) {
    put("scene.toml",
        replaced(small_scene(), "reflectance = 0.5", "reradiation = { file = \"my.csv\" }"));
    for (const auto& [text, options] : std::initializer_list<std::pair<std::string, const char*>>{
             {as_german_sheet(multiplied(orange(), 100)),
              "--rows emission --quantity per-band --scale percent"},
             {as_german_sheet(multiplied(transposed(orange()), 100)),
              "--rows excitation --quantity per-band --scale percent"},
             {joined(multiplied(orange(), 0.1, true), "\t"),
              "--rows emission --quantity density"}}) {
        put("my.csv", text);
        const std::string command = std::string("convert my.csv matrix.csv ") + options;
        for (const char* arguments :
             {"colour my.csv", "fit my.csv -o fitted.csv", "info my.csv", "validate my.csv",
              "convert my.csv matrix.csv", "render scene.toml -o out.exr"}) {
            const ProgramResult result = run(arguments);
            EXPECT_EQ(result.exit_code, 2);
            EXPECT_EQ(proposed(result.errors), command) << arguments << "\n" << result.errors;
        }
        const ProgramResult converted = run(command);
        EXPECT_EQ(converted.exit_code, 0) << converted.errors;
        EXPECT_EQ(converted.errors, "");
        const auto lab = json_of("colour matrix.csv --against " RERADIANT_SOURCE_DIR
                                 "/spectra/reradiation/synthetic-orange.csv");
        EXPECT_LT(lab["D65"]["ciede2000"].get<double>(), 1e-3);
        EXPECT_EQ(run("validate matrix.csv").errors, "");
        std::filesystem::remove(folder / "matrix.csv");
    }
}

TEST_F(OwnMatrix, AWrongDeclarationIsWarnedAboutWhereverTheMatrixIsRead) {
    expect_warned(measured + joined(transposed(orange()), ","),
                  "rows and columns are probably exchanged");
    expect_warned(measured + joined(multiplied(orange(), 0.1, true), ","),
                  "declare '# quantity: density-per-nm'");
    put("hot.csv", replaced(measured, "per-band", "density-per-nm") + joined(orange(), ","));
    EXPECT_NE(run("colour hot.csv").errors.find("declare '# quantity: per-band'"),
              std::string::npos);
    put("scene.toml",
        replaced(small_scene(), "reflectance = 0.5", "reradiation = { file = \"hot.csv\" }"));
    expect_failure(2, "validate scene.toml", "declare '# quantity: per-band'");
    put("hot.csv", measured + joined(multiplied(orange(), 100), ","));
    expect_failure(2, "colour hot.csv", "'# unit: percent'");
    put("hot.csv", declared + joined(transposed(orange()), ","));
    expect_failure(2, "colour hot.csv", "declare the other '# orientation'");
    expect_failure(2, "colour hot.csv", "'# anti-stokes: allowed'");
}

TEST_F(OwnMatrix, ConvertTellsItsInputFromItsOutput) {
    const std::string file = RERADIANT_SOURCE_DIR "/spectra/reradiation/synthetic-orange.csv";
    ASSERT_EQ(
        run("convert " + file + " d.csv --out-rows excitation --out-quantity density").exit_code,
        0);
    EXPECT_NE(file_bytes(folder / "d.csv").find("rows-excitation"), std::string::npos);
    EXPECT_NE(file_bytes(folder / "d.csv").find("density-per-nm"), std::string::npos);
    expect_failure(2, "convert " + file + " x.csv --rows excitation", "'orientation' contradicts");
    expect_failure(2, "convert d.csv x.exr --out-rows emission", "--out-rows");
    expect_failure(2, "convert d.csv x.csv --scale none", "none");
    ASSERT_EQ(run("convert d.csv d.bfc").exit_code, 0);
    expect_failure(2, "convert d.bfc x.csv --rows emission", "d.bfc: a BFC-450 file says itself");
    put("s.csv", "400,0.4\n500,0.5\n");
    expect_failure(2, "convert s.csv x.csv --scale percent", "s.csv: --rows");
    // A measurement keeps its gaps for `fit`.
    put("gaps.csv", "nm;400;410\n400;0,5;\n410;;0,5\n");
    const std::string told = " --rows emission --quantity per-band --kind measured";
    EXPECT_EQ(run("convert gaps.csv g.csv" + told).exit_code, 0);
    EXPECT_NE(file_bytes(folder / "g.csv").find("nan"), std::string::npos);
    expect_failure(2, "convert gaps.csv x.csv --rows emission --quantity per-band",
                   "gaps.csv:3:5: a value is missing");
}

TEST_F(OwnMatrix, ValidateTakesWhatOtherCommandsTake) {
    const std::string source = RERADIANT_SOURCE_DIR;
    put("layers.toml", "[[material.layer]]\nior = 1.5\n");
    put("gaps.csv", measured + "nm,400,410\n400,0.5,0\n410,,0.5\n");
    ASSERT_EQ(run("measure --preset fluorescent-orange-bare -o m.csv --theta-i 45 --theta-o 0 "
                  "--bands 400:600:50")
                  .exit_code,
              0);
    std::filesystem::copy_file(folder / "m.csv", folder / "m.txt");
    put("s.txt", "400\t0,4\n500\t0,5\n");
    put("c.ocio", "ocio_profile_version: 2\nroles: {default: lin, scene_linear: lin, "
                  "aces_interchange: lin}\ndisplays:\n  screen:\n    - !<View> {name: raw, "
                  "colorspace: lin}\ncolorspaces:\n  - !<ColorSpace>\n    name: lin\n");
    put("broken.ocio", "ocio_profile_version: 2\nroles:\n  scene_linear: nothing\n");
    expect_failure(2, "validate broken.ocio", "broken.ocio: OpenColorIO refuses this");
    for (const auto& [file, kind] : std::initializer_list<std::pair<std::string, const char*>>{
             {source + "/tools/examples/synth-orange.toml", "recipe of synth"},
             {source + "/tools/examples/studies/varnish.toml", "study"},
             {source + "/spectra/polygons/en-iso-20471.csv", "polygons of colour"},
             {source + "/spectra/metals/gold.csv", "complex index of refraction"},
             {source + "/tools/examples/presets.png", "image"},
             {source + "/spectra/materials/brass.toml", "material"},
             {"layers.toml", "layers"},
             {"gaps.csv", "re-radiation matrix"},
             {"m.csv", "measurement"},
             {"m.txt", "measurement"},
             {"s.txt", "spectrum"},
             {"c.ocio", "config of OpenColorIO"}})
        EXPECT_EQ(json_of("validate " + file)["kind"], kind) << file;
}

} // namespace reradiant
