#pragma once

#include "host/spectral/grid.h"

#include <vector>

namespace reradiant {

/// grid_from_centres for centres that were rounded by at most `rounding_nm`, a fifth of the step or
/// less: of the grids that fit them, the one whose first centre and step are whole multiples of the
/// largest of 1, 1/2, 1/3 ... 1/12 nm, so that 383.33, 386.67, 390 becomes 383 1/3 by 3 1/3; else
/// the one from the first to the last centre.
WavelengthGrid grid_from_rounded_centres(const std::vector<double>& centres_nm, double rounding_nm,
                                         double step_of_single_nm = 1.0);

} // namespace reradiant
