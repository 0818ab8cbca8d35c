#include "host/spectral/colour/colour_polygons.h"
#include "reradiant/error.h"
#include "tests/support/scratch_folder.h"

#include <cmath>

using namespace reradiant;

namespace {

class ColourPolygons : public test::ScratchFolder {
protected:
    void expect_refused(const std::string& text, const std::string& place) const {
        const auto file = write("bad.csv", text);
        try {
            read_colour_polygons(file);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2);
            EXPECT_EQ(error.position().text(), file.string() + place) << error.what();
        }
    }
};

constexpr const char* headings = "name,illuminant,minimum_luminance_factor,corners\n";

} // namespace

TEST_F(ColourPolygons, TheStandardsColoursAreTellable) {
    const auto polygons = read_colour_polygons(std::filesystem::path(RERADIANT_SOURCE_DIR) /
                                               "spectra" / "polygons" / "en-iso-20471.csv");
    ASSERT_EQ(polygons.size(), 3u);
    EXPECT_EQ(polygons[1].name, "fluorescent orange-red");
    EXPECT_TRUE(polygons[0].holds({0.40, 0.53}));
    EXPECT_TRUE(polygons[1].holds({0.6, 0.37}));
    EXPECT_FALSE(polygons[1].holds({0.6, 0.33}));
    EXPECT_TRUE(polygons[2].holds({0.62, 0.33}));
    EXPECT_FALSE(polygons[0].holds({0.3127, 0.3290})); // white
    for (const ColourPolygon& polygon : polygons)
        for (const auto& corner : polygon.corners)
            EXPECT_TRUE(polygon.holds(corner)) << polygon.name;
    EXPECT_FALSE(polygons[0].holds({std::nan(""), 0.5}));
}

TEST_F(ColourPolygons, ConcaveRegionsAreReadInOrder) {
    const auto polygons = read_colour_polygons(
        write("l.csv", std::string("# an L\n") + headings +
                           "l,A,0,0.1,0.1,0.5,0.1,0.5,0.2,0.2,0.2,0.2,0.5,0.1,0.5\n"));
    EXPECT_TRUE(polygons[0].holds({0.4, 0.15}));
    EXPECT_TRUE(polygons[0].holds({0.15, 0.4}));
    EXPECT_FALSE(polygons[0].holds({0.4, 0.4}));
}

TEST_F(ColourPolygons, BothConditionsCount) {
    ColourPolygon polygon;
    polygon.minimum_luminance_factor = 0.4;
    polygon.corners = {{0.2, 0.2}, {0.4, 0.2}, {0.3, 0.4}};
    MatrixColour colour;
    colour.xy = {0.3, 0.3};
    colour.xyz = {30.0, 39.0, 40.0};
    EXPECT_TRUE(test_polygon(polygon, colour).chromaticity);
    EXPECT_FALSE(test_polygon(polygon, colour).passes());
    colour.xyz[1] = 40.0;
    EXPECT_TRUE(test_polygon(polygon, colour).passes());
}

TEST_F(ColourPolygons, BadFilesAreRefusedAtTheirPlace) {
    expect_refused("", ":1:1");
    expect_refused(headings, ":1:1");
    expect_refused("name,x,y\n", ":1:1");
    const std::string start = headings;
    expect_refused(start + "a,D65,0.1\n", ":2:7");
    expect_refused(start + "a,D99,0.1,0,0,1,0,0,1\n", ":2:3");
    expect_refused(start + "a,D65,40,0,0,1,0,0,1\n", ":2:7");
    expect_refused(start + "a,D65,0.1,0,0,1,0\n", ":2:17");
    expect_refused(start + "a,D65,0.1,0,0,1,0,0,x\n", ":2:21");
    expect_refused(start + "a,D65,0.1,0,0,1,0,0.6,0.6\n", ":2:19");
    expect_refused(start + "a,D65,0.1,0,0,0.1,0.1,0.2,0.2\n", ":2:11");
}
