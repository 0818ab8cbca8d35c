#pragma once

#include "host/fit/data/fit_target.h"
#include "host/fit/factors/factor_start.h"

namespace reradiant {

/// Gives values to bands of a term that the data say next to nothing about, because less than 1 %
/// of what the term emits by them (square sum) lies in entries that were used: columns that were
/// not measured, and those whose only emission the spill beside the diagonal hides. A gap is
/// bridged straight; beyond the last band that is known a curve goes on straight if it falls, level
/// if it rises. The data, the diagonal among them, may object, and columns keep
/// their photon budget.
void bridge_hidden_bands(const FitTarget& target, FactorCurves& curves);

} // namespace reradiant
