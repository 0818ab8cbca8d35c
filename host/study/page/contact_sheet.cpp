#include "host/study/page/contact_sheet.h"

#include "host/figure/figure.h"
#include "host/figure/svg_drawing.h"
#include "host/film/display/display_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <variant>

namespace reradiant {

namespace {

// Points of the drawing are pixels of the sheet.
constexpr double pixels_per_inch = 72.0;
constexpr double font_size = 11.0, gap = 8.0;
constexpr double narrowest_cell = 128.0; ///< so that there is room for its title
constexpr double widest_cell = 512.0;

/// Width of a cell on the sheet: its image's own, times or over a whole number.
double cell_width(int image_width) {
    double width = image_width;
    if (width < narrowest_cell)
        width *= std::ceil(narrowest_cell / width);
    if (width > widest_cell)
        width /= std::ceil(width / widest_cell);
    return width;
}

/// Writes the picture of a cell anew at the exposure of all.
Picture developed(const CellResult& cell, double exposure_ev) {
    DisplayOptions display;
    display.exposure_ev = exposure_ev;
    Picture picture = display_picture(read_spectral_exr(cell.folder / "image.exr"), display);
    write_picture(cell.folder / "image.png", picture);
    return picture;
}

} // namespace

SheetLayout sheet_layout(const Study& study) {
    SheetLayout layout;
    layout.row_sweeps = study.sweeps.size() / 2;
    for (std::size_t k = 0; k < study.sweeps.size(); ++k)
        (k < layout.row_sweeps ? layout.rows : layout.columns) *= study.sweeps[k].values.size();
    return layout;
}

void write_contact_sheet(const std::filesystem::path& file, const Study& study,
                         const StudyResult& result) {
    const SheetLayout layout = sheet_layout(study);
    Figure sheet;
    sheet.font_size = font_size;
    sheet.gap = sheet.margin = gap;
    sheet.has_letters = false;
    sheet.rows.assign(layout.rows, std::vector<FigurePanel>(
                                       layout.columns, FigurePanel{"", EmptyPanel{"not done"}}));
    const Picture* first = nullptr;
    for (const CellResult& cell : result.cells) {
        FigurePanel& panel = sheet.rows[cell.index / layout.columns][cell.index % layout.columns];
        panel.title = fmt::format("{}", fmt::join(cell_values(study, cell), "\n"));
        panel.content = EmptyPanel{"failed"};
        if (!cell.has_image || cell.failed())
            continue;
        panel.content = PicturePanel{.picture = developed(cell, result.exposure_ev)};
        first = first ? first : &std::get<PicturePanel>(panel.content).picture;
    }
    if (!first)
        return;
    for (auto& row : sheet.rows)
        for (FigurePanel& panel : row)
            if (std::holds_alternative<EmptyPanel>(panel.content))
                panel.aspect = static_cast<double>(first->width) / first->height;
    sheet.width = static_cast<double>(layout.columns) * (cell_width(first->width) + gap) - gap;
    write_picture(file, picture_of_svg(figure_svg(sheet), pixels_per_inch));
}

} // namespace reradiant
