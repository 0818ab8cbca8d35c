#include "host/spectral/colour/colour_polygons.h"

#include "host/spectral/text/text_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reradiant {

namespace {

using Point = std::array<double, 2>;

constexpr std::string_view headings = "name,illuminant,minimum_luminance_factor,corners";
constexpr std::size_t tokens_before_corners = 3;

/// Distance from a point to the segment a b.
double distance(const Point& p, const Point& a, const Point& b) {
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    const double length = dx * dx + dy * dy;
    const double along = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (length > 0.0 ? length : 1.0);
    const double t = std::clamp(along, 0.0, 1.0);
    return std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

double area(const std::vector<Point>& corners) {
    double twice = 0.0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Point &a = corners[k], &b = corners[(k + 1) % corners.size()];
        twice += a[0] * b[1] - b[0] * a[1];
    }
    return 0.5 * std::abs(twice);
}

std::vector<Point> read_corners(const TextReader& reader, const std::vector<TextToken>& tokens) {
    const std::size_t numbers = tokens.size() - tokens_before_corners;
    if (numbers < 6 || numbers % 2 != 0)
        throw_input_error(reader.position(tokens.back()),
                          fmt::format("{} numbers are not the corners of a polygon", numbers),
                          "write x1,y1,x2,y2,x3,y3 or more pairs");
    std::vector<Point> corners;
    for (std::size_t k = tokens_before_corners; k < tokens.size(); k += 2) {
        const Point corner{reader.number(tokens[k]), reader.number(tokens[k + 1])};
        if (!(corner[0] >= 0.0 && corner[1] >= 0.0 && corner[0] + corner[1] <= 1.0))
            throw_input_error(
                reader.position(tokens[k]),
                fmt::format("no colour has x = {}, y = {}", corner[0], corner[1]),
                "x and y of the CIE 1931 diagram are at least 0 and at most 1 together");
        corners.push_back(corner);
    }
    if (!(area(corners) > 0.0))
        throw_input_error(reader.position(tokens[tokens_before_corners]), "the polygon has no area",
                          "give its corners in order around");
    return corners;
}

ColourPolygon read_polygon(const TextReader& reader, const std::vector<TextToken>& tokens) {
    if (tokens.size() <= tokens_before_corners)
        throw_input_error(reader.position(tokens.back()), "the line is not a polygon",
                          fmt::format("write {}", headings));
    ColourPolygon polygon;
    polygon.name = std::string(tokens[0].text);
    polygon.illuminant = std::string(tokens[1].text);
    try {
        illuminant(polygon.illuminant);
    } catch (const std::invalid_argument& error) {
        throw_input_error(reader.position(tokens[1]), error.what());
    }
    polygon.minimum_luminance_factor = reader.number(tokens[2]);
    if (!(polygon.minimum_luminance_factor >= 0.0 && polygon.minimum_luminance_factor <= 10.0))
        throw_input_error(reader.position(tokens[2]),
                          fmt::format("a luminance factor of {}", polygon.minimum_luminance_factor),
                          "unit 1; divide percent by 100");
    polygon.corners = read_corners(reader, tokens);
    polygon.line = reader.line_number();
    return polygon;
}

} // namespace

bool ColourPolygon::holds(const Point& xy) const {
    // Standards print corners with three decimals; this is rounding of the colour itself.
    constexpr double on_boundary = 1e-9;
    bool inside = false;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Point &a = corners[k], &b = corners[(k + 1) % corners.size()];
        if (distance(xy, a, b) <= on_boundary)
            return true;
        // A ray towards +x crosses the edge.
        if ((a[1] > xy[1]) != (b[1] > xy[1]) &&
            xy[0] < a[0] + (xy[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside;
}

std::vector<ColourPolygon> read_colour_polygons(const std::filesystem::path& file) {
    TextReader reader(file);
    std::vector<ColourPolygon> polygons;
    bool past_headings = false;
    for (std::string_view line; reader.next_line(line);) {
        if (trimmed(line).empty() || trimmed(line).starts_with('#'))
            continue;
        if (past_headings)
            polygons.push_back(read_polygon(reader, reader.split_cells(line)));
        else if (trimmed(line) == headings)
            past_headings = true;
        else
            throw_input_error(reader.position(reader.line_number(), 1),
                              "these headings are not known", fmt::format("write {}", headings));
    }
    if (polygons.empty())
        throw_input_error(reader.end_position(), "no polygon in this file",
                          fmt::format("write {}", headings));
    return polygons;
}

PolygonResult test_polygon(const ColourPolygon& polygon, const MatrixColour& colour) {
    return {polygon.holds(colour.xy), colour.xyz[1] / 100.0 >= polygon.minimum_luminance_factor};
}

} // namespace reradiant
