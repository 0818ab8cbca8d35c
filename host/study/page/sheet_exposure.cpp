#include "host/study/page/sheet_exposure.h"

#include "host/film/colour_image.h"
#include "reradiant/spectral_image.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace reradiant {

namespace {

constexpr double darkest = 0.1, brightest = 0.9, shown_at = 0.6;

/// Median of the largest channel over pixels that are not black; 0 where all are.
double body_level(const SpectralImage& image) {
    std::vector<double> levels;
    for (const Xyz& xyz : xyz_image(image)) {
        const auto rgb = xyz_to_linear_srgb(xyz);
        const double level = *std::max_element(rgb.begin(), rgb.end());
        if (level > 0.0 && std::isfinite(level))
            levels.push_back(level);
    }
    if (levels.empty())
        return 0.0;
    const auto middle = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2);
    std::nth_element(levels.begin(), middle, levels.end());
    return *middle;
}

} // namespace

double sheet_exposure_ev(const Study& study, const StudyResult& result) {
    if (!study.rendering)
        return 0.0;
    if (study.rendering->exposure_ev)
        return *study.rendering->exposure_ev;
    double level = 0.0;
    for (const CellResult& cell : result.cells)
        if (cell.has_image && !cell.failed())
            level = std::max(level, body_level(read_spectral_exr(cell.folder / "image.exr")));
    if (level == 0.0 || (level >= darkest && level <= brightest))
        return 0.0;
    return std::round(10.0 * std::log2(shown_at / level)) / 10.0; // as it is written on the page
}

} // namespace reradiant
