#pragma once

#include "reradiant/colour_of_matrix.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// A `ColourPolygon` is what a standard asks of a colour: a region of the CIE 1931 chromaticity
/// diagram and a smallest luminance factor.
struct ColourPolygon {
    std::string name;
    std::string illuminant;                     ///< as `illuminant` of colour.h knows it
    double minimum_luminance_factor = 0.0;      ///< unit 1, fluorescence included
    std::vector<std::array<double, 2>> corners; ///< x, y in order around, at least 3
    int line = 0;                               ///< of the file

    /// The boundary belongs to the region.
    bool holds(const std::array<double, 2>& xy) const;
};

/// Reads polygons from a CSV with '#' comments: the line of headings
/// `name,illuminant,minimum_luminance_factor,corners`, then a polygon a line with x1,y1,x2,y2,...
/// as its corners. Input Error with the place, also for an empty file, an illuminant that does not
/// exist, fewer than 3 corners, a corner that no colour has, and a polygon without area.
std::vector<ColourPolygon> read_colour_polygons(const std::filesystem::path& file);

struct PolygonResult {
    bool chromaticity = false, luminance_factor = false;
    bool passes() const { return chromaticity && luminance_factor; }
};
PolygonResult test_polygon(const ColourPolygon& polygon, const MatrixColour& colour);

} // namespace reradiant
