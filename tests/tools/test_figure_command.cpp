#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace reradiant {

namespace {

using Json = nlohmann::json;

constexpr const char* head = "[figure]\nwidth_mm = 80\ndpi = 60\ncaption = \"A caption\"\n";
constexpr const char* image = "[[image]]\nname = \"day\"\nfile = \"a.exr\"\n";
constexpr const char* mark = "[[image.mark]]\nname = \"dark\"\nat = [2, 3]\nradius = 1.5\n";
constexpr const char* region = "[[image.mark]]\nname = \"bright\"\nregion = [8, 0, 11, 7]\n";
constexpr const char* panels = "[[plot]]\nname = \"spectra\"\n[[swatches]]\nname = \"colours\"\n";

class FigureCommand : public ProgramTest {
protected:
    /// The right half of each is twice as bright as the left one; `b` is four times `a`.
    void write_images() const {
        for (const bool is_bright : {false, true}) {
            SpectralImage values = flat_image(12, 8, grid_from_range(400, 700, 20), 0.1f);
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 12; ++x)
                    for (int band = 0; band < values.bands.count; ++band)
                        values.at(x, y, band) *= (x < 6 ? 1.0f : 2.0f) * (is_bright ? 4.0f : 1.0f);
            write_spectral_exr(folder / (is_bright ? "b.exr" : "a.exr"), values);
        }
    }

    Json figure_json(const std::string& text) const {
        put("f.toml", text);
        const ProgramResult result = run("figure f.toml -o f.png --json f.json");
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return Json::parse(file_bytes(folder / "f.json"));
    }

    /// The figure must be refused at this place, and nothing written.
    void expect_refusal(const std::string& text, const std::string& place) const {
        put("f.toml", text);
        expect_failure(2, "figure f.toml -o f.svg", "f.toml:" + place);
    }
};

} // namespace

TEST_F(FigureCommand, WritesEveryFormAndSaysWhatIsSeen) {
    write_images();
    const std::string text = std::string(head) + image + mark + region + panels;
    const Json json = figure_json(text);
    ASSERT_EQ(json.at("marks").size(), 2u);
    EXPECT_EQ(json.at("marks").at(0).at("name"), "day.dark");
    const double dark = json.at("marks").at(0).at("XYZ").at(1);
    const double bright = json.at("marks").at(1).at("XYZ").at(1);
    EXPECT_NEAR(bright / dark, 2.0, 1e-6);
    for (const std::string ending : {"svg", "pdf", "png"}) {
        const ProgramResult result = run("figure f.toml -o g." + ending);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_NE(result.output.find("3 panels"), std::string::npos) << result.output;
        EXPECT_EQ(run("figure f.toml -o again." + ending).exit_code, 0);
        EXPECT_TRUE(file_bytes(folder / ("g." + ending)) ==
                    file_bytes(folder / ("again." + ending)))
            << ending << " differs from run to run";
    }
    EXPECT_EQ(file_bytes(folder / "g.pdf").substr(0, 4), "%PDF");
    EXPECT_EQ(file_bytes(folder / "g.png").substr(1, 3), "PNG");
    EXPECT_EQ(run("validate f.toml").exit_code, 0);
}

TEST_F(FigureCommand, ExposureIsSharedOrNot) {
    write_images();
    const std::string both = std::string(image) + "[[image]]\nname = \"sun\"\nfile = \"b.exr\"\n";
    const auto exposures = [](const Json& json) {
        return std::pair<double, double>(json.at("images").at(0).at("exposure_ev"),
                                         json.at("images").at(1).at("exposure_ev"));
    };
    const auto shared = exposures(figure_json(head + both));
    EXPECT_EQ(shared.first, shared.second);
    const auto fixed = exposures(figure_json(std::string(head) + "exposure = -1.5\n" + both));
    EXPECT_EQ(fixed, std::pair(-1.5, -1.5));
    const auto own = exposures(figure_json(head + both + "exposure = 2\n"));
    EXPECT_EQ(own.second, 2.0);
    const auto apart = exposures(figure_json(std::string(head) + "exposure = \"auto\"\n" + both));
    EXPECT_EQ(apart.first, 0.0);
    EXPECT_LT(apart.second, 0.0) << "the brighter image is shown darker";
}

TEST_F(FigureCommand, RowsCropsRatiosAndWhitesAreTaken) {
    write_images();
    const std::string text =
        "[figure]\nrows = [[\"day\", \"day\"], [\"ratio\"], [\"colours\"]]\nletters = false\n"
        "white = \"A\"\ngamut = \"compress\"\n" +
        std::string(image) + "crop = [0, 0, 7, 7]\ntitle = \"Crop\"\n" + mark + region +
        "[[plot]]\nname = \"ratio\"\nmarks = [\"day.bright\"]\nagainst = \"day.dark\"\n"
        "logarithmic = true\naspect = 3\n"
        "[[swatches]]\nname = \"colours\"\nmarks = [\"day.dark\"]\nagainst = \"day.bright\"\n"
        "lamp = \"A\"\nwhite_luminance = 0.3\n";
    const Json json = figure_json(text);
    EXPECT_NEAR(json.at("images").at(0).at("white_xy").at(0), 0.4476, 1e-3);
}

TEST_F(FigureCommand, WhatIsWrongIsSaidAtItsPlace) {
    write_images();
    const std::string good = std::string(image) + mark;
    expect_refusal("[figure]\nrows = [[\"night\"]]\n" + good, "2:");
    expect_refusal("[figure]\nrows = [\"day\"]\n" + good, "2:");
    expect_refusal("[figure]\nrows = []\n" + good, "2:");
    expect_refusal("[figure]\nwidth = 3\n" + good, "2:");
    expect_refusal("[figure]\nexposure = \"bright\"\n" + good, "2:");
    expect_refusal("[figure]\nwhite = \"Sun\"\n" + good, "2:");
    expect_refusal("[figure]\nwhite = \"0.9,0.9\"\n" + good, "2:");
    expect_refusal("[figure]\ndpi = 0\n" + good, "2:");
    expect_refusal("[figure]\n", "");
    expect_refusal("[[image]]\nname = \"a\"\nfile = \"none.exr\"\n", "3:");
    expect_refusal("[[image]]\nname = \"a\"\nfile = \"f.toml\"\n", "3:");
    expect_refusal(std::string(image) + "exposure = \"shared\"\n", "4:");
    expect_refusal(std::string(image) + "groups = { day = 1 }\n", "4:");
    expect_refusal(std::string(image) + "groups = { day = -1 }\n", "4:");
    expect_refusal(std::string(image) + "groups = 1\n", "4:");
    expect_refusal(std::string(image) + "crop = [0, 0, 12, 7]\n", "4:");
    expect_refusal(std::string(image) + "crop = [5, 0, 4, 7]\n", "4:");
    expect_refusal(good + image, "9:");
    expect_refusal(good + "[[image.mark]]\nname = \"dark\"\nat = [1, 1]\n", "8:");
}

TEST_F(FigureCommand, WrongMarksAreSaidAtTheirPlace) {
    write_images();
    const auto marked = [](const std::string& keys) {
        return std::string(image) + "[[image.mark]]\nname = \"m\"\n" + keys;
    };
    expect_refusal(marked(""), "5:");
    expect_refusal(marked("at = [1]\n"), "6:");
    expect_refusal(marked("at = [1.5, 1]\n"), "6:");
    expect_refusal(marked("at = [1, 1]\nregion = [0, 0, 1, 1]\n"), "7:");
    expect_refusal(marked("region = [0, 0, 1, 1]\nradius = 2\n"), "7:");
    expect_refusal(marked("at = [12, 1]\n"), "4:");
    expect_refusal(marked("at = [0, 0]\nradius = 2\n"), "4:");
    const std::string good = marked("at = [1, 1]\n");
    expect_refusal(good + "[[plot]]\nname = \"p\"\nmarks = [\"m\"]\n", "9:");
    expect_refusal(good + "[[plot]]\nname = \"p\"\nmarks = []\n", "9:");
    expect_refusal(good + "[[plot]]\nname = \"p\"\nagainst = \"day.x\"\n", "9:");
    expect_refusal(good + "[[swatches]]\nname = \"p\"\nlamp = \"Sun\"\n", "9:");
    expect_refusal(std::string(image) + "[[plot]]\nname = \"p\"\n", "4:");
    put("f.toml", "[figure]\nwidth_mm = 2000\ndpi = 2400\n" + good);
    expect_failure(2, "figure f.toml -o f.png", "lower dpi");
    put("f.toml", good);
    expect_failure(2, "figure f.toml -o f.jpg", "f.jpg");
    expect_failure(2, "figure f.toml -o f", "f");
    expect_failure(2, "figure f.toml -o a.exr", "a.exr");
    expect_failure(2, "figure missing.toml -o f.svg", "missing.toml");
}

} // namespace reradiant
