#include "host/study/page/contact_sheet.h"

#include "host/film/display/display_picture.h"
#include "host/film/display/png.h"

#include <algorithm>

namespace reradiant {

namespace {

constexpr int gap = 4;
constexpr std::uint8_t grey = 128;
/// Wider cells are shown at every second, third, ... pixel.
constexpr int widest_cell = 512;

/// The sheet while it is filled, (height, width, 3).
struct Sheet {
    int cell_width, cell_height, width, height;
    std::vector<std::uint8_t> rgb;

    Sheet(const SheetLayout& layout, int cell_width_, int cell_height_)
        : cell_width(cell_width_), cell_height(cell_height_),
          width(static_cast<int>(layout.columns) * (cell_width + gap) + gap),
          height(static_cast<int>(layout.rows) * (cell_height + gap) + gap),
          rgb(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), grey) {}

    void put(std::size_t row, std::size_t column, const std::vector<std::uint8_t>& cell,
             int full_width, int step) {
        const int left = gap + static_cast<int>(column) * (cell_width + gap);
        const int top = gap + static_cast<int>(row) * (cell_height + gap);
        for (int y = 0; y < cell_height; ++y)
            for (int x = 0; x < cell_width; ++x)
                std::copy_n(cell.begin() + 3 * (y * step * full_width + x * step), 3,
                            rgb.begin() + 3 * ((top + y) * width + left + x));
    }
};

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
    std::optional<Sheet> sheet;
    for (const CellResult& cell : result.cells) {
        if (!cell.has_image || cell.failed())
            continue;
        const SpectralImage image = read_spectral_exr(cell.folder / "image.exr");
        DisplayOptions display;
        display.exposure_ev = result.exposure_ev;
        const Picture picture = display_picture(image, display);
        write_picture(cell.folder / "image.png", picture);
        const int step = (image.width + widest_cell - 1) / widest_cell;
        const int width = image.width / step, height = std::max(1, image.height / step);
        if (!sheet)
            sheet.emplace(layout, width, height);
        if (width != sheet->cell_width || height != sheet->cell_height)
            continue; // a swept film size: the sheet shows the first
        sheet->put(cell.index / layout.columns, cell.index % layout.columns, picture.rgb,
                   image.width, step);
    }
    if (sheet)
        write_png(file, sheet->width, sheet->height, sheet->rgb, true);
}

} // namespace reradiant
