#pragma once

#include "host/figure/figure_layout.h"

#include <string>

namespace reradiant {

/// What stands beneath a panel's title, as SVG; lengths are points.
std::string draw_panel(const PlacedPanel& placed, double font_size);

/// Height that swatches take in a width, all in points.
double swatches_height(const SwatchPanel& panel, double width, double font_size);

/// A line of text; anchor is start, middle or end, `style` further attributes of the element.
std::string draw_text(double x, double y, double size, const std::string& text,
                      const std::string& anchor = "start", const std::string& style = {});

} // namespace reradiant
