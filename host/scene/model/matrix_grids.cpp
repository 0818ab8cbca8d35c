#include "host/scene/model/matrix_grids.h"

#include "reradiant/reradiation.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

/// True when the bands of both lie on one raster, to 1e-6 of a step.
bool share_raster(const WavelengthGrid& a, const WavelengthGrid& b) {
    const double offset = (b.from_nm - a.from_nm) / a.step_nm;
    return std::fabs(b.step_nm - a.step_nm) <= 1e-6 * a.step_nm &&
           std::fabs(offset - std::round(offset)) <= 1e-6;
}

} // namespace

std::vector<const ReradiationMatrix*> matrices_of(const Material& material) {
    std::vector<const ReradiationMatrix*> matrices;
    if (material.substrate.matrix)
        matrices.push_back(material.substrate.matrix.get());
    for (const Layer& layer : material.stack.layers)
        for (const SlabDye& dye : layer.dyes)
            if (dye.shares && dye.absorbs() && layer.thickness > 0.0)
                matrices.push_back(dye.shares.get());
    return matrices;
}

std::optional<WavelengthGrid> common_grid(const std::vector<const ReradiationMatrix*>& matrices) {
    if (matrices.empty())
        return std::nullopt;
    const WavelengthGrid& first = matrices.front()->emission;
    double from = first.from_nm, to = first.to_nm();
    for (const ReradiationMatrix* matrix : matrices)
        for (const WavelengthGrid* grid : {&matrix->emission, &matrix->excitation}) {
            if (!share_raster(first, *grid))
                return std::nullopt;
            from = std::min(from, grid->from_nm);
            to = std::max(to, grid->to_nm());
        }
    const double step = first.step_nm;
    return WavelengthGrid{from, step, static_cast<int>(std::lround((to - from) / step)) + 1};
}

} // namespace reradiant
