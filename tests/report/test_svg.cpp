#include "host/report/svg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <regex>

using namespace reradiant::svg;

namespace {

const double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Looking is part of testing a plot: with RERADIANT_PLOT_FOLDER set they are left there.
void keep(const std::string& name, const std::string& svg) {
    if (const char* folder = std::getenv("RERADIANT_PLOT_FOLDER"))
        std::ofstream(std::string(folder) + "/" + name + ".svg") << svg;
}

int count(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    return static_cast<int>(std::distance(
        std::sregex_iterator(text.begin(), text.end(), expression), std::sregex_iterator()));
}

/// Elements opened and closed in order, no element of an id, no number that is none.
void expect_sound(const std::string& svg) {
    std::vector<std::string> open;
    const std::regex tag("<(/?)([a-z]+)[^>]*?(/?)>");
    for (std::sregex_iterator at(svg.begin(), svg.end(), tag), end; at != end; ++at) {
        const std::smatch& match = *at;
        if (match[1].length() > 0) {
            ASSERT_FALSE(open.empty());
            EXPECT_EQ(open.back(), match[2].str());
            open.pop_back();
        } else if (match[3].length() == 0) {
            open.push_back(match[2].str());
        }
    }
    EXPECT_TRUE(open.empty());
    for (const char* wrong : {" id=", "nan", "inf"})
        EXPECT_EQ(svg.find(wrong), std::string::npos) << wrong;
}

Series curve(const std::string& label, double centre) {
    Series series{.label = label, .x = {}, .y = {}};
    for (int l = 400; l <= 700; l += 10) {
        const double y = std::exp(-std::pow((l - centre) / 40.0, 2));
        series.x.push_back(l);
        series.y.push_back(y);
        series.low.push_back(y - 0.03);
        series.high.push_back(y + 0.05);
    }
    return series;
}

HeatMap gaussian_map(Eigen::Index rows, Eigen::Index columns) {
    HeatMap map{.title = "a matrix",
                .x_label = "excitation / nm",
                .y_label = "emission / nm",
                .x = {},
                .y = {},
                .value = Eigen::MatrixXd(rows, columns)};
    for (Eigen::Index i = 0; i < columns; ++i)
        map.x.push_back(300.0 + 10.0 * static_cast<double>(i));
    for (Eigen::Index o = 0; o < rows; ++o) {
        map.y.push_back(380.0 + 10.0 * static_cast<double>(o));
        for (Eigen::Index i = 0; i < columns; ++i)
            map.value(o, i) = std::exp(-std::pow((static_cast<double>(o) - 22) / 4.0, 2) -
                                       std::pow((static_cast<double>(i) - 18) / 6.0, 2));
    }
    return map;
}

} // namespace

TEST(Svg, LinePlotDrawsEverySeriesWithItsBandAndLegend) {
    Series marks = curve("data & more", 550);
    marks.points = true;
    marks.low.clear();
    marks.high.clear();
    const std::string svg =
        line_plot({.title = "Emission", .x_label = "wavelength / nm", .y_label = "value"},
                  {curve("first", 500), curve("second", 600), marks});
    keep("lines", svg);
    expect_sound(svg);
    EXPECT_EQ(count(svg, "fill-opacity=\"0.2\"/>"), 2 + 2); // bands, and their legend
    EXPECT_EQ(count(svg, "<circle"), 31 + 1);
    EXPECT_EQ(count(svg, "stroke-linejoin"), 2);
    EXPECT_NE(svg.find("data &amp; more"), std::string::npos);
}

TEST(Svg, GapsBreakALine) {
    Series series{.label = "", .x = {1, 2, 3, 4, 5}, .y = {1, 2, nan_value, 2, 1}};
    const std::string svg = line_plot({}, {series});
    expect_sound(svg);
    std::smatch path;
    ASSERT_TRUE(std::regex_search(svg, path, std::regex("<path d=\"([^\"]*)\" fill=\"none\"")));
    EXPECT_EQ(count(path[1].str(), "M"), 2);
    EXPECT_EQ(count(path[1].str(), "L"), 2);
}

TEST(Svg, LogarithmicPlotLeavesOutWhatHasNoLogarithm) {
    Series series{.label = "error", .x = {0.0, 0.1, 1, 10, 100}, .y = {1, 0.3, 1e-2, -1, 1e-5}};
    const std::string svg = line_plot({.title = "error against seconds",
                                       .x_label = "seconds",
                                       .y_label = "relMSE",
                                       .log_x = true,
                                       .log_y = true},
                                      {series});
    keep("log-log", svg);
    expect_sound(svg);
    EXPECT_NE(svg.find("10⁻⁵"), std::string::npos);
}

TEST(Svg, NothingToDrawIsStillAPlot) {
    expect_sound(line_plot({}, {}));
    expect_sound(line_plot({.log_y = true}, {{.label = "gone", .x = {1}, .y = {nan_value}}}));
}

TEST(Svg, LengthsMustAgree) {
    EXPECT_THROW(line_plot({}, {{.label = "", .x = {1, 2}, .y = {1}}}), std::invalid_argument);
    EXPECT_THROW(line_plot({}, {{.label = "", .x = {1}, .y = {1}, .low = {1}}}),
                 std::invalid_argument);
    HeatMap map = gaussian_map(3, 4);
    map.x.pop_back();
    EXPECT_THROW(heat_map(map), std::invalid_argument);
    map = gaussian_map(3, 4);
    map.x[1] += 1.0;
    EXPECT_THROW(heat_map(map), std::invalid_argument);
    map = gaussian_map(3, 4);
    map.y.clear();
    EXPECT_THROW(heat_map(map), std::invalid_argument);
}

TEST(Svg, HeatMapShowsTheMatrixAndItsGaps) {
    HeatMap map = gaussian_map(41, 49);
    map.value.block(3, 5, 2, 7).setConstant(nan_value);
    const std::string svg = heat_map(map);
    keep("heat", svg);
    expect_sound(svg);
    std::smatch grey;
    ASSERT_TRUE(std::regex_search(svg, grey, std::regex("fill=\"#bbb\" d=\"([^\"]*)\"")));
    EXPECT_EQ(grey[1].str(), "M5 3h7v1h-7zM5 4h7v1h-7z");
    // The largest value has the last colour of the bar, which is used there once more.
    EXPECT_EQ(count(svg, "M18 22h1v1h-1z"), 1);
}

TEST(Svg, HeatMapOutlinesMarkedCells) {
    HeatMap map = gaussian_map(36, 40); // cells of 10 x 10
    map.marked = Eigen::MatrixXd::Zero(36, 40);
    map.marked(2, 3) = map.marked(2, 4) = 1.0;
    const std::string svg = heat_map(map);
    expect_sound(svg);
    EXPECT_EQ(count(svg, "h9.0v-9.0h-9.0z"), 2);
    map.marked = Eigen::MatrixXd::Zero(36, 39);
    EXPECT_THROW(heat_map(map), std::invalid_argument);
}

TEST(Svg, DivergingMapIsCentredAtZero) {
    HeatMap map = gaussian_map(41, 49);
    map.value.array() -= 0.25;
    map.diverging = true;
    const std::string svg = heat_map(map);
    keep("residuals", svg);
    expect_sound(svg);
    EXPECT_NE(svg.find(">-0.5<"), std::string::npos); // the bar reaches from -0.75 to 0.75
    EXPECT_NE(svg.find(">0.5<"), std::string::npos);
}

TEST(Svg, LargeMatricesStaySmall) {
    EXPECT_LT(heat_map(gaussian_map(81, 97)).size(), 200000u);
}

TEST(Svg, EmptyMatrixOfZerosIsAPlot) {
    HeatMap map = gaussian_map(5, 6);
    map.value.setZero();
    expect_sound(heat_map(map));
    map.value.setConstant(nan_value);
    expect_sound(heat_map(map));
}
