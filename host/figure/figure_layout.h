#pragma once

#include "host/figure/figure.h"

#include <string>
#include <vector>

namespace reradiant {

/// Where a panel stands; all in points from the figure's upper left corner.
struct PlacedPanel {
    const FigurePanel* panel = nullptr;
    std::size_t index = 0;               ///< among all panels, which gives its letter
    double x = 0.0, y = 0.0;             ///< of the content, beneath the title
    double width = 0.0, height = 0.0;    ///< of the content
    std::vector<std::string> title = {}; ///< lines
    double title_y = 0.0;                ///< base line of its first line
    double title_x = 0.0;                ///< beside the letter
};

struct FigureLayout {
    std::vector<PlacedPanel> panels;
    std::vector<std::string> caption;
    double caption_y = 0.0; ///< base line of its first line
    double height = 0.0;    ///< of the whole figure
};

/// Distance of the lines of a text, in units of the font's size.
inline constexpr double line_step = 1.3;

/// Panels of a row are equally high and fill the figure's width together; a row grows no higher
/// than three quarters of it.
FigureLayout layout_of(const Figure& figure);

} // namespace reradiant
