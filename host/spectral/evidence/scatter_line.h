#pragma once

#include "reradiant/scatter_line.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

namespace reradiant {

/// 1 for the entries whose emission band reaches into ratio * excitation +- the half width, so that
/// a line between two bands takes both; else 0. Never the diagonal: that is the reflectance.
/// (emission, excitation).
Eigen::MatrixXd entries_on(const ScatterLine& line, const WavelengthGrid& emission,
                           const WavelengthGrid& excitation);

/// Returns whether both bands have the same centre, to 1e-6 of the smaller step.
bool on_diagonal(const WavelengthGrid& emission, int o, const WavelengthGrid& excitation, int i);

} // namespace reradiant
