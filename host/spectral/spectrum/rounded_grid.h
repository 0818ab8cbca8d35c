#pragma once

#include "reradiant/wavelength_grid.h"

#include <vector>

namespace reradiant {

/// A wavelength as a text gives it.
struct RoundedWavelength {
    double nm = 0.0;
    double rounding_nm = 0.0; ///< what half a unit of the last digit stands for
};

/// Returns the grid of ascending centres that were rounded, each by a fifth of the step at most, as
/// grid_from_centres does for exact ones. It is, of the grids that fit them, the one whose first
/// centre and step are whole multiples of the largest of 1, 1/2, 1/3 ... 1/64 nm, so that 383.33,
/// 386.67, 390 becomes 383 1/3 by 3 1/3; else the one from the first to the last centre. Throws
/// std::invalid_argument as grid_from_centres does.
WavelengthGrid grid_from_rounded_centres(const std::vector<RoundedWavelength>& centres,
                                         double step_of_single_nm = 1.0);

} // namespace reradiant
