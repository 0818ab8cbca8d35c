#pragma once

#include "host/film/display/develop.h"
#include "host/report/svg.h"

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace reradiant {

/// A place of a picture with a ring or a frame about it; in pixels of the picture, whose upper left
/// corner is (0, 0).
struct FigureMark {
    std::string label;
    std::size_t colour =
        0; ///< index of a plot's series colour, so that curves look like their marks
    double x = 0.0, y = 0.0;
    double half_width = 0.5, half_height = 0.5;
    bool is_round = true;
};

struct PicturePanel {
    Picture picture;
    std::vector<FigureMark> marks = {};
    std::string note = {}; ///< a few characters at the right end of the title's line
};

struct PlotPanel {
    svg::Axes axes;
    std::vector<svg::Series> series;
};

struct Swatch {
    std::string label;
    std::vector<std::string> values; ///< a line each
    std::array<std::uint8_t, 3> rgb{};
};
struct SwatchPanel {
    std::vector<Swatch> swatches;
};

/// A grey place where a picture would be.
struct EmptyPanel {
    std::string text;
};

struct FigurePanel {
    std::string title; ///< may be empty
    std::variant<PicturePanel, PlotPanel, SwatchPanel, EmptyPanel> content;
    double aspect = 0.0; ///< width over height; 0: a picture's own, or what suits the content
};

/// What a figure shows: rows of panels as wide as the figure, each row's panels equally high.
struct Figure {
    double width = 482.0;     ///< points of 1/72 inch
    double font_size = 8.0;   ///< points
    double gap = 10.0;        ///< between panels, points
    double margin = 0.0;      ///< about all, outside the width, points
    bool has_letters = true;  ///< (a), (b), ... before the titles
    std::string caption = {}; ///< beneath the panels; may be empty
    std::vector<std::vector<FigurePanel>> rows;
};

/// The name by which a panel is known in texts: a, b, ... z, aa, ab, ...
std::string panel_letter(std::size_t index);

/// A figure as SVG whose fonts are names. std::invalid_argument for a figure without panels.
std::string figure_svg(const Figure& figure);

} // namespace reradiant
