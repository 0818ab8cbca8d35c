#pragma once

#include "host/fit/dye/dye_model.h"

#include <vector>

namespace reradiant {

/// Data sets made ready, and the problem that refers to them.
struct PreparedDyes {
    std::vector<DyeDataSet> sets;
    DyeProblem problem;
};

/// Checks that settings and data belong together and makes the problem, with depths up to
/// `largest_depth`. Input Error as fit_dyes.
PreparedDyes prepare_dyes(const std::vector<BispectralData>& data, const DyeFitSettings& settings,
                          double largest_depth);

/// Makes the problem's tables anew for depths up to another one.
void set_largest_depth(PreparedDyes& prepared, const DyeFitSettings& settings,
                       double largest_depth);

} // namespace reradiant
