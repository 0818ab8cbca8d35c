#pragma once

#include "host/spectral/spectrum/grid.h"

#include <Eigen/Core>

#include <array>
#include <string_view>

namespace reradiant {

/// Light of the lamp that gratings pass at a multiple of its wavelength: emission = ratio times
/// excitation with ratio 1, 2, 3 or 1/2.
enum class ScatterOrder { First, Second, Third, Half };
inline constexpr std::array scatter_orders = {ScatterOrder::First, ScatterOrder::Second,
                                              ScatterOrder::Third, ScatterOrder::Half};
/// `first`, `second`, `third` or `half`.
std::string_view scatter_order_name(ScatterOrder order);
double scatter_ratio(ScatterOrder order);

/// A line of scattered light across a matrix.
struct ScatterLine {
    ScatterOrder order = ScatterOrder::Second;
    double half_width_nm = 0.0; ///< of emission

    bool operator==(const ScatterLine&) const = default;
};

/// 1 for the entries whose emission band reaches into ratio * excitation +- the half width, so that
/// a line between two bands takes both; else 0. Never the diagonal: that is the reflectance.
/// (emission, excitation).
Eigen::MatrixXd entries_on(const ScatterLine& line, const WavelengthGrid& emission,
                           const WavelengthGrid& excitation);

/// Returns whether both bands have the same centre, to 1e-6 of the smaller step.
bool on_diagonal(const WavelengthGrid& emission, int o, const WavelengthGrid& excitation, int i);

} // namespace reradiant
