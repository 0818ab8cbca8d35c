#include "host/figure/figure.h"

#include "host/figure/figure_layout.h"
#include "host/figure/panel_drawing.h"
#include "host/figure/svg_drawing.h"

#include <fmt/core.h>

namespace reradiant {

namespace {

std::string draw_title(const PlacedPanel& placed, const Figure& figure) {
    const double size = figure.font_size;
    std::string drawn;
    if (figure.has_letters)
        drawn += draw_text(placed.x, placed.title_y, size, "(" + panel_letter(placed.index) + ")",
                           "start", "font-weight=\"bold\"");
    double y = placed.title_y;
    for (const std::string& line : placed.title) {
        drawn += draw_text(placed.title_x, y, size, line);
        y += line_step * size;
    }
    const auto* picture = std::get_if<PicturePanel>(&placed.panel->content);
    if (picture && !picture->note.empty())
        drawn += draw_text(placed.x + placed.width, placed.title_y, size, picture->note, "end",
                           "fill=\"#666\"");
    return drawn;
}

} // namespace

std::string panel_letter(std::size_t index) {
    constexpr std::size_t letters = 26;
    const std::string last(1, static_cast<char>('a' + index % letters));
    return index < letters ? last : panel_letter(index / letters - 1) + last;
}

std::string figure_svg(const Figure& figure) {
    const FigureLayout layout = layout_of(figure);
    const double margin = figure.margin;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
        "width=\"{1:.4f}pt\" height=\"{2:.4f}pt\" viewBox=\"{0:.4f} {0:.4f} {1:.4f} {2:.4f}\" "
        "font-family=\"{3}\" fill=\"#222\">\n<rect x=\"{0:.4f}\" y=\"{0:.4f}\" "
        "width=\"{1:.4f}\" height=\"{2:.4f}\" fill=\"#fff\"/>\n",
        -margin, figure.width + 2.0 * margin, layout.height + 2.0 * margin, figure_font);
    for (const PlacedPanel& placed : layout.panels)
        svg += draw_title(placed, figure) + draw_panel(placed, figure.font_size);
    double y = layout.caption_y;
    for (const std::string& line : layout.caption) {
        svg += draw_text(0.0, y, figure.font_size, line);
        y += line_step * figure.font_size;
    }
    return svg + "</svg>\n";
}

} // namespace reradiant
