#include "host/study/page/sheet_exposure.h"

#include "host/film/colour_image.h"
#include "host/film/display/picture_levels.h"
#include "reradiant/spectral_image.h"

#include <algorithm>

namespace reradiant {

double sheet_exposure_ev(const Study& study, const StudyResult& result) {
    if (!study.rendering)
        return 0.0;
    if (study.rendering->exposure_ev)
        return *study.rendering->exposure_ev;
    double level = 0.0;
    for (const CellResult& cell : result.cells)
        if (cell.has_image && !cell.failed())
            level = std::max(level,
                             body_level(xyz_image(read_spectral_exr(cell.folder / "image.exr"))));
    return exposure_of_level(level);
}

} // namespace reradiant
