#include "host/figure/figure.h"
#include "host/figure/figure_layout.h"
#include "host/figure/svg_drawing.h"
#include "host/figure/wrapped_text.h"
#include "reradiant/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace reradiant {
namespace {

/// A picture whose pixels all differ from their neighbours.
Picture checkered(int width, int height) {
    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.encoding.is_srgb = true;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int channel : {0, 1, 2})
                picture.rgb.push_back(
                    static_cast<std::uint8_t>(40 * ((x + 2 * y + channel) % 6) + 10));
    return picture;
}

FigurePanel picture_panel(const std::string& title, int width, int height) {
    return {.title = title, .content = PicturePanel{.picture = checkered(width, height)}};
}

std::array<std::uint8_t, 3> pixel_of(const Picture& picture, int x, int y) {
    const auto first = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                            static_cast<std::size_t>(x));
    return {picture.rgb[first], picture.rgb[first + 1], picture.rgb[first + 2]};
}

TEST(WrappedText, LinesFitAndNothingIsLost) {
    const std::string text = "The dye absorbs what it has emitted itself, and moves to the red";
    const std::vector<std::string> lines = wrapped_text(text, 12.0);
    EXPECT_GT(lines.size(), 2u);
    std::string joined;
    for (const std::string& line : lines) {
        EXPECT_LE(text_width(line), 12.0) << line;
        joined += (joined.empty() ? "" : " ") + line;
    }
    EXPECT_EQ(joined, text);
    EXPECT_TRUE(wrapped_text("", 10.0).empty());
    EXPECT_EQ(wrapped_text("one\ntwo", 10.0), (std::vector<std::string>{"one", "two"}));
}

TEST(WrappedText, WordsThatAreTooWideAreCutBetweenCharacters) {
    const std::vector<std::string> lines = wrapped_text("Öööööööööööööööööööö", 5.0);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_LE(text_width(lines[0]), 5.0);
    EXPECT_EQ(lines[0].substr(lines[0].size() - 3), "…");
    EXPECT_EQ((lines[0].size() - 3) % 2, 0u) << "characters of two bytes stay whole";
}

TEST(FigureLayout, PanelsOfARowAreEquallyHighAndFillTheWidth) {
    Figure figure;
    figure.width = 300.0;
    figure.gap = 10.0;
    figure.rows = {{picture_panel("a", 40, 20), picture_panel("b", 20, 20)},
                   {picture_panel("c", 30, 20)}};
    const FigureLayout layout = layout_of(figure);
    ASSERT_EQ(layout.panels.size(), 3u);
    EXPECT_NEAR(layout.panels[0].height, 290.0 / 3.0, 1e-9);
    EXPECT_NEAR(layout.panels[1].height, layout.panels[0].height, 1e-9);
    EXPECT_NEAR(layout.panels[1].x + layout.panels[1].width, 300.0, 1e-9);
    EXPECT_NEAR(layout.panels[2].width, 300.0, 1e-9);
    EXPECT_GT(layout.panels[2].y, layout.panels[0].y + layout.panels[0].height);
    figure.caption = "A caption";
    EXPECT_GT(layout_of(figure).height, layout.height);
    figure.rows = {{}};
    EXPECT_THROW(layout_of(figure), std::invalid_argument);
}

TEST(FigureLayout, AHighPictureDoesNotMakeThePageLong) {
    Figure figure;
    figure.rows = {{picture_panel("", 10, 100)}};
    EXPECT_LE(layout_of(figure).panels[0].height, 0.75 * figure.width + 1e-9);
}

TEST(FigureLayout, LettersGoOnBehindZ) {
    EXPECT_EQ(panel_letter(0), "a");
    EXPECT_EQ(panel_letter(25), "z");
    EXPECT_EQ(panel_letter(26), "aa");
    EXPECT_EQ(panel_letter(26 * 27), "aaa");
}

/// At one pixel a point, pictures whose places are whole numbers are not resampled.
TEST(FigureDrawing, PicturesKeepTheirPixels) {
    Figure figure;
    figure.width = 32.0 + 6.0 + 32.0;
    figure.gap = figure.margin = 6.0;
    figure.has_letters = false;
    figure.rows = {{picture_panel("x", 32, 20), picture_panel("", 32, 20)}};
    const Picture drawn = picture_of_svg(figure_svg(figure), 72.0);
    const PlacedPanel second = layout_of(figure).panels[1];
    const Picture original = checkered(32, 20);
    ASSERT_EQ(drawn.width, 82);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 32; ++x)
            EXPECT_EQ(pixel_of(drawn, x + 6 + static_cast<int>(std::lround(second.x)),
                               y + 6 + static_cast<int>(std::lround(second.y))),
                      pixel_of(original, x, y));
    EXPECT_EQ(pixel_of(drawn, 0, 0), (std::array<std::uint8_t, 3>{255, 255, 255}));
}

Figure full_figure() {
    Figure figure;
    figure.caption = "Caption & <more>";
    FigurePanel picture = picture_panel("Title with <markup> & \"quotes\"", 60, 30);
    std::get<PicturePanel>(picture.content).marks = {
        {.label = "left & <b>", .colour = 0, .x = 5.0, .y = 5.0},
        {.label = "at the right", .colour = 8, .x = 58.0, .y = 20.0, .is_round = false}};
    PlotPanel plot;
    plot.series = {{.label = "one", .x = {400, 500, 600}, .y = {1.0, std::nan(""), 2.0}}};
    SwatchPanel swatches{{{"white", {"L* 100"}, {255, 255, 255}}, {"red", {}, {255, 0, 0}}}};
    figure.rows = {{picture, {"", EmptyPanel{"failed"}}}, {{"", plot}, {"", swatches}}};
    return figure;
}

TEST(FigureDrawing, EveryFormBringsItsFonts) {
    const std::string svg = figure_svg(full_figure());
    EXPECT_EQ(svg.find("<markup>"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    const std::string outlines = svg_with_outlines(svg);
    EXPECT_TRUE(outlines.find("<text") == std::string::npos) << "texts are outlines";
    const std::string pdf = pdf_of_svg(svg);
    EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
    EXPECT_NE(pdf.find("/FontFile"), std::string::npos) << "the font is in the file";
    EXPECT_TRUE(pdf == pdf_of_svg(svg)) << "the date is not in it";
    EXPECT_EQ(pixel_of(picture_of_svg(svg, 100.0), 0, 0),
              (std::array<std::uint8_t, 3>{255, 255, 255}));
}

TEST(FigureDrawing, MarksHaveTheColoursOfTheirCurves) {
    Figure figure = full_figure();
    const std::string svg = figure_svg(figure);
    const std::string ring = "stroke=\"" + std::string("#0072b2") + "\"";
    EXPECT_NE(svg.find(ring), std::string::npos);
    auto& plot = std::get<PlotPanel>(figure.rows[1][0].content);
    plot.series[0].colour = 2;
    EXPECT_NE(figure_svg(figure).find("#009e73"), std::string::npos);
}

TEST(FigureDrawing, SizesWithoutEndAreRefused) {
    const std::string svg = figure_svg(full_figure());
    EXPECT_THROW(picture_of_svg(svg, 1e6), Error);
    EXPECT_THROW(picture_of_svg(svg, std::numeric_limits<double>::infinity()), Error);
    EXPECT_THROW(picture_of_svg("no drawing", 72.0), Error);
    EXPECT_THROW(pdf_of_svg("<svg"), Error);
}

} // namespace
} // namespace reradiant
