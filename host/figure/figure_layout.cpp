#include "host/figure/figure_layout.h"

#include "host/figure/panel_drawing.h"
#include "host/figure/svg_drawing.h"
#include "host/figure/wrapped_text.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr double highest_row = 0.75; // of the figure's width
constexpr double title_margin = 0.4; // between a title and what stands beneath, in font sizes

double aspect_of(const FigurePanel& panel, bool is_alone) {
    if (panel.aspect > 0.0)
        return panel.aspect;
    if (const auto* picture = std::get_if<PicturePanel>(&panel.content))
        return static_cast<double>(picture->picture.width) / picture->picture.height;
    if (std::holds_alternative<PlotPanel>(panel.content))
        return is_alone ? 2.4 : 1.45;
    return is_alone ? 10.0 : 1.0;
}

const std::string& note_of(const FigurePanel& panel) {
    static const std::string none;
    const auto* picture = std::get_if<PicturePanel>(&panel.content);
    return picture ? picture->note : none;
}

/// Places one row after another.
struct Placing {
    const Figure& figure;
    FigureLayout layout = {};
    double y = 0.0;

    void add_row(const std::vector<FigurePanel>& row);
    void place_title(PlacedPanel& placed) const;
    void add_caption();
};

void Placing::place_title(PlacedPanel& placed) const {
    const double size = figure.font_size;
    const std::string& note = note_of(*placed.panel);
    const std::string letter = "(" + panel_letter(placed.index) + ") ";
    const double indent = figure.has_letters ? text_width(letter, true) : 0.0;
    const double room =
        placed.width / size - indent - (note.empty() ? 0.0 : text_width(note) + 0.5);
    placed.title_x = placed.x + indent * size;
    placed.title = wrapped_text(placed.panel->title, std::max(room, 1.0));
    const bool needs_line = figure.has_letters || !note.empty();
    if (placed.title.empty() && needs_line)
        placed.title.emplace_back();
}

void Placing::add_row(const std::vector<FigurePanel>& row) {
    double aspects = 0.0;
    for (const FigurePanel& panel : row)
        aspects += aspect_of(panel, row.size() == 1);
    const double room = figure.width - figure.gap * static_cast<double>(row.size() - 1);
    const double height = std::min(room / aspects, highest_row * figure.width);
    const std::size_t first = layout.panels.size();
    double x = 0.0;
    double row_height = 0.0;
    std::size_t lines = 0;
    for (const FigurePanel& panel : row) {
        PlacedPanel placed{.panel = &panel, .index = layout.panels.size(), .x = x};
        placed.width = height * aspect_of(panel, row.size() == 1);
        const auto* swatches = std::get_if<SwatchPanel>(&panel.content);
        placed.height =
            swatches ? swatches_height(*swatches, placed.width, figure.font_size) : height;
        place_title(placed);
        lines = std::max(lines, placed.title.size());
        row_height = std::max(row_height, placed.height);
        x += placed.width + figure.gap;
        layout.panels.push_back(std::move(placed));
    }
    // Pictures keep their place among whole points, which are the pixels of contact sheets.
    const double titles =
        lines == 0
            ? 0.0
            : std::ceil(figure.font_size * (line_step * static_cast<double>(lines) + title_margin));
    for (std::size_t k = first; k < layout.panels.size(); ++k) {
        layout.panels[k].title_y = y + figure.font_size;
        layout.panels[k].y = y + titles;
    }
    y += titles + row_height + figure.gap;
}

void Placing::add_caption() {
    layout.caption = wrapped_text(figure.caption, figure.width / figure.font_size);
    layout.caption_y = y + figure.font_size;
    if (layout.caption.empty())
        y -= figure.gap;
    y += line_step * figure.font_size * static_cast<double>(layout.caption.size());
    layout.height = y;
}

} // namespace

FigureLayout layout_of(const Figure& figure) {
    Placing placing{figure};
    for (const auto& row : figure.rows)
        if (!row.empty())
            placing.add_row(row);
    if (placing.layout.panels.empty())
        throw std::invalid_argument("a figure needs a panel");
    placing.add_caption();
    return placing.layout;
}

} // namespace reradiant
