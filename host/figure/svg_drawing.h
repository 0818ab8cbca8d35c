#pragma once

#include "host/film/display/develop.h"

#include <string>

namespace reradiant {

/// A drawing in the three forms that print takes. Its texts become outlines in SVG and bring
/// their font with them in PDF, so that it looks the same on every machine.
///
/// The argument is SVG whose `width` and `height` are in points. Each throws a run-time Error for
/// what the library refuses.
std::string svg_with_outlines(const std::string& svg);
std::string pdf_of_svg(const std::string& svg);
/// Pixels on white, sRGB, at `dpi` pixels an inch; at most `largest_drawing_side` a side.
Picture picture_of_svg(const std::string& svg, double dpi);
inline constexpr int largest_drawing_side = 30000;

/// Width that a text takes in a figure's font, in units of the font's size.
double text_width(const std::string& text, bool is_bold = false);

/// The font of figures, as SVG names it.
inline constexpr const char* figure_font = "DejaVu Sans, Helvetica, Arial, sans-serif";

} // namespace reradiant
