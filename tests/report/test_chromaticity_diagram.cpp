#include "host/report/chromaticity_diagram.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <stdexcept>

using namespace reradiant::svg;

namespace {

/// A triangle for a locus.
ChromaticityDiagram small_diagram() {
    ChromaticityDiagram diagram;
    diagram.title = "observer";
    diagram.nm = {460.0, 520.0, 700.0};
    diagram.locus = {{0.14, 0.03}, {0.07, 0.83}, {0.73, 0.27}};
    diagram.series = {"D65", "A"};
    diagram.whites = {{0.3127, 0.3290}, {0.4476, 0.4074}};
    diagram.points = {{"one <under> D65", "1", 0, {0.4, 0.4}, Chromaticity{0.38, 0.4}},
                      {"one under A", "", 1, {0.5, 0.4}}};
    return diagram;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at)
        ++found;
    return found;
}

} // namespace

TEST(ChromaticityDiagram, DrawsLocusWhitesAndPoints) {
    const std::string svg = chromaticity_diagram(small_diagram());
    if (const char* folder = std::getenv("RERADIANT_PLOT_FOLDER"))
        std::ofstream(std::string(folder) + "/chromaticity.svg") << svg;
    EXPECT_EQ(count(svg, "<svg "), 1u);
    for (const char* wavelength : {">460<", ">520<", ">700<"})
        EXPECT_EQ(count(svg, wavelength), 1u) << wavelength;
    EXPECT_EQ(count(svg, "h10m-5 -5v10"), 2u) << "crosses of whites";
    EXPECT_EQ(count(svg, "<title>one &lt;under&gt; D65</title>"), 1u);
    EXPECT_EQ(count(svg, "r=\"3\" fill=\"#fff\""), 1u) << "the ring at a line's other end";
    // 0.4 lies in the middle of 0 to 0.8 and at 4/9 of 0 to 0.9, 640 pixels to the unit.
    EXPECT_EQ(count(svg, "<circle cx=\"334.0\" cy=\"360.0\" r=\"4\""), 1u) << svg;
}

TEST(ChromaticityDiagram, NamesOfRegionsStandApart) {
    ChromaticityDiagram diagram = small_diagram();
    for (const char* name : {"first", "second", "third"})
        diagram.regions.push_back({name, {{0.5, 0.35}, {0.55, 0.35}, {0.55, 0.4}}});
    const std::string svg = chromaticity_diagram(diagram);
    std::vector<double> heights;
    for (const char* name : {">first<", ">second<", ">third<"}) {
        const std::size_t at = svg.find(name);
        ASSERT_NE(at, std::string::npos) << name;
        heights.push_back(std::stod(svg.substr(svg.rfind(" y=\"", at) + 4)));
    }
    for (const double a : heights)
        for (const double b : heights)
            EXPECT_TRUE(&a == &b || a == b || std::abs(a - b) >= 12.0) << a << ' ' << b;
    EXPECT_NE(heights[0], heights[1]);
    EXPECT_NE(heights[1], heights[2]);
}

TEST(ChromaticityDiagram, WhatIsNotSeenIsNotDrawn) {
    ChromaticityDiagram diagram = small_diagram();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    diagram.points[0].xy = {nan, nan};
    diagram.points[1].from = Chromaticity{nan, 0.3};
    diagram.whites[1] = {nan, nan};
    const std::string svg = chromaticity_diagram(diagram);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(count(svg, "<title>"), 1u);
}

TEST(ChromaticityDiagram, WhatDoesNotFitTogetherIsRefused) {
    ChromaticityDiagram short_locus = small_diagram();
    short_locus.locus.pop_back();
    EXPECT_THROW(chromaticity_diagram(short_locus), std::invalid_argument);
    ChromaticityDiagram stray = small_diagram();
    stray.points[0].series = 2;
    EXPECT_THROW(chromaticity_diagram(stray), std::invalid_argument);
}
