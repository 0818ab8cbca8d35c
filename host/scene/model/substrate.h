#pragma once

#include "reradiant/scene.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

namespace reradiant {

/// The fluorescent part of a substrate on cells: (cells.count, cells.count), rows = emission,
/// per-band. The diagonal is the fluorescence within a cell; the reflectance is left out
/// (fluorescence_on_cells).
Eigen::MatrixXd fluorescence_of(const Substrate& substrate, const WavelengthGrid& cells);

} // namespace reradiant
