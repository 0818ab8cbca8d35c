#include "host/spectral/evidence/scatter_contrast.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

/// Bands beyond the clearance that may be missing before a neighbour is too far away to say much.
constexpr double longest_gap = 4.0;

} // namespace

bool ScatterContrast::is_usable(int o, int i) const {
    const double shift = matrix_.emission.centre_nm(o) - matrix_.excitation.centre_nm(i);
    const double near = settings_.spill_nm + 1e-6 * matrix_.emission.step_nm;
    return std::isfinite(matrix_.values(o, i)) && std::abs(shift) > near &&
           (shift > 0.0 || settings_.anti_stokes);
}

/// The next usable entry from (o, i) in steps of (down, right) beyond the clearance.
std::optional<ScatterContrast::Neighbour>
ScatterContrast::neighbour(int o, int i, int down, int right, const ScatterStencil& stencil) const {
    const double step = std::max(matrix_.emission.step_nm, ratio_ * matrix_.excitation.step_nm);
    const double farthest = stencil.clearance_nm + longest_gap * step;
    for (int n = 1;; ++n) {
        const int row = o + n * down, column = i + n * right;
        if (row < 0 || row >= matrix_.emission.count || column < 0 ||
            column >= matrix_.excitation.count)
            return std::nullopt;
        const double to_line = distance_nm(row, column);
        const double to_moved = std::abs(to_line - stencil.shift_nm);
        if (to_moved > farthest)
            return std::nullopt;
        if (to_moved > stencil.clearance_nm && std::abs(to_line) > stencil.clearance_nm &&
            is_usable(row, column))
            return Neighbour{matrix_.values(row, column),
                             n * (down != 0 ? matrix_.emission : matrix_.excitation).step_nm};
    }
}

/// Returns what the neighbours in one direction say of an entry, by linear interpolation between
/// them. The diagonal bounds what a fluorophore emits, so that beside it only those farther out say
/// something.
std::optional<double> ScatterContrast::expected(int o, int i, int down, int right,
                                                const ScatterStencil& stencil) const {
    const auto after = neighbour(o, i, down, right, stencil);
    const auto before = is_first_ ? std::nullopt : neighbour(o, i, -down, -right, stencil);
    if (before && after)
        return (before->value * after->away_nm + after->value * before->away_nm) /
               (before->away_nm + after->away_nm);
    if (!before && !after)
        return std::nullopt;
    return before ? before->value : after->value;
}

std::optional<double> ScatterContrast::operator()(int o, int i,
                                                  const ScatterStencil& stencil) const {
    if (!is_usable(o, i))
        return std::nullopt;
    const int outward = distance_nm(o, i) > 0.0 ? 1 : -1;
    const auto along_emission = expected(o, i, outward, 0, stencil);
    const auto along_excitation = expected(o, i, 0, -outward, stencil);
    if (!along_emission || !along_excitation)
        return std::nullopt;
    return matrix_.values(o, i) - std::max(*along_emission, *along_excitation);
}

} // namespace reradiant
