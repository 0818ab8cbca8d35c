#include "host/figure/panel_drawing.h"

#include "host/figure/svg_drawing.h"
#include "host/film/display/png.h"
#include "host/report/data_uri.h"
#include "host/report/html.h"
#include "host/report/plot_frame.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

/// Outlines in white make marks readable on any picture.
std::string draw_outline(const FigureMark& mark, double x, double y, double rx, double ry,
                         double font_size) {
    std::string outline;
    for (const bool is_halo : {true, false}) {
        const std::string stroke = fmt::format(
            "fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\"",
            is_halo ? "#fff" : svg::series_colour(mark.colour), font_size * (is_halo ? 0.3 : 0.14));
        outline += mark.is_round ? fmt::format("<ellipse cx=\"{:.2f}\" cy=\"{:.2f}\" rx=\"{:.2f}\" "
                                               "ry=\"{:.2f}\" {}/>\n",
                                               x, y, rx, ry, stroke)
                                 : fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
                                               "height=\"{:.2f}\" {}/>\n",
                                               x - rx, y - ry, 2.0 * rx, 2.0 * ry, stroke);
    }
    return outline;
}

std::string draw_mark(const PlacedPanel& placed, const PicturePanel& panel, const FigureMark& mark,
                      double font_size) {
    const double smallest = 0.35 * font_size;
    const double scale_x = placed.width / panel.picture.width;
    const double scale_y = placed.height / panel.picture.height;
    const double x = placed.x + scale_x * mark.x, y = placed.y + scale_y * mark.y;
    const double rx = std::max(smallest, scale_x * mark.half_width);
    const double ry = std::max(smallest, scale_y * mark.half_height);
    const double distance = rx + 0.4 * font_size;
    const bool is_left =
        x + distance + font_size * text_width(mark.label) > placed.x + placed.width;
    std::string drawn = draw_outline(mark, x, y, rx, ry, font_size);
    for (const bool is_halo : {true, false})
        drawn += draw_text(is_left ? x - distance : x + distance, y + 0.35 * font_size, font_size,
                           mark.label, is_left ? "end" : "start",
                           is_halo ? fmt::format("stroke=\"#fff\" stroke-linejoin=\"round\" "
                                                 "stroke-width=\"{:.2f}\"",
                                                 0.35 * font_size)
                                   : std::string());
    return drawn;
}

std::string draw(const PlacedPanel& placed, const PicturePanel& panel, double font_size) {
    const Picture& picture = panel.picture;
    const std::string png = png_bytes(picture.width, picture.height, picture.rgb, picture.encoding);
    std::string drawn =
        fmt::format("<image x=\"{:.4f}\" y=\"{:.4f}\" width=\"{:.4f}\" height=\"{:.4f}\" "
                    "preserveAspectRatio=\"none\" xlink:href=\"data:image/png;base64,{}\"/>\n",
                    placed.x, placed.y, placed.width, placed.height, base64(png));
    for (const FigureMark& mark : panel.marks)
        drawn += draw_mark(placed, panel, mark, font_size);
    return drawn;
}

std::string draw(const PlacedPanel& placed, const PlotPanel& panel, double font_size) {
    constexpr double size_in_plots = 12.0;
    const double scale = font_size / size_in_plots;
    return fmt::format("<g transform=\"translate({:.3f} {:.3f}) scale({:.5f})\">\n{}</g>\n",
                       placed.x, placed.y, scale,
                       svg::line_plot_within(panel.axes, panel.series, placed.width / scale,
                                             placed.height / scale));
}

/// Swatches stand in a grid of equal cells: a square, and texts to its right.
struct SwatchGrid {
    double side, cell_width, cell_height;
    std::size_t columns, rows;
};

SwatchGrid grid_of(const SwatchPanel& panel, double width, double font_size) {
    double widest = 0.0;
    std::size_t lines = 0;
    for (const Swatch& swatch : panel.swatches) {
        widest = std::max(widest, text_width(swatch.label));
        for (const std::string& line : swatch.values)
            widest = std::max(widest, text_width(line));
        lines = std::max(lines, 1 + swatch.values.size());
    }
    SwatchGrid grid{};
    grid.side = font_size * std::max(2.6, line_step * static_cast<double>(lines));
    grid.cell_width = grid.side + font_size * (widest + 1.5);
    grid.cell_height = grid.side + 0.6 * font_size;
    const double fitting = std::clamp(std::floor(width / grid.cell_width), 1.0,
                                      static_cast<double>(panel.swatches.size()));
    grid.columns = static_cast<std::size_t>(fitting);
    grid.rows = (panel.swatches.size() + grid.columns - 1) / grid.columns;
    return grid;
}

std::string draw_swatch(const Swatch& swatch, double x, double y, double side, double font_size) {
    std::string drawn = fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
                                    "height=\"{:.2f}\" fill=\"#{:02x}{:02x}{:02x}\"/>\n",
                                    x, y, side, side, swatch.rgb[0], swatch.rgb[1], swatch.rgb[2]);
    const double left = x + side + 0.5 * font_size;
    double base = y + font_size;
    drawn += draw_text(left, base, font_size, swatch.label);
    for (const std::string& line : swatch.values)
        drawn += draw_text(left, base += line_step * font_size, font_size, line, "start",
                           "fill=\"#666\"");
    return drawn;
}

std::string draw(const PlacedPanel& placed, const SwatchPanel& panel, double font_size) {
    if (panel.swatches.empty())
        return {};
    const SwatchGrid grid = grid_of(panel, placed.width, font_size);
    std::string drawn;
    for (std::size_t k = 0; k < panel.swatches.size(); ++k) {
        const std::size_t row = k / grid.columns, column = k % grid.columns;
        drawn += draw_swatch(
            panel.swatches[k], placed.x + grid.cell_width * static_cast<double>(column),
            placed.y + grid.cell_height * static_cast<double>(row), grid.side, font_size);
    }
    return drawn;
}

std::string draw(const PlacedPanel& placed, const EmptyPanel& panel, double font_size) {
    return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                       "fill=\"#ddd\"/>\n",
                       placed.x, placed.y, placed.width, placed.height) +
           draw_text(placed.x + 0.5 * placed.width, placed.y + 0.5 * placed.height, font_size,
                     panel.text, "middle");
}

} // namespace

double swatches_height(const SwatchPanel& panel, double width, double font_size) {
    if (panel.swatches.empty())
        return 0.0;
    const SwatchGrid grid = grid_of(panel, width, font_size);
    return grid.cell_height * static_cast<double>(grid.rows);
}

std::string draw_text(double x, double y, double size, const std::string& text,
                      const std::string& anchor, const std::string& style) {
    return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.2f}\" text-anchor=\"{}\""
                       "{}{}>{}</text>\n",
                       x, y, size, anchor, style.empty() ? "" : " ", style, markup_escaped(text));
}

std::string draw_panel(const PlacedPanel& placed, double font_size) {
    return std::visit([&](const auto& content) { return draw(placed, content, font_size); },
                      placed.panel->content);
}

} // namespace reradiant
