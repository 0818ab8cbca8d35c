#pragma once

#include <Eigen/Core>

namespace reradiant {

/// Steps that the numbers of a table were rounded to, seen in the numbers themselves: all are
/// multiples of one step (a fixed count of decimals, or levels of a converter), or have no more
/// than five significant decimal or twelve binary digits. Of every entry, in its own unit; zero
/// where finer than that. Entries that are NaN are not looked at.
Eigen::MatrixXd rounding_steps(const Eigen::MatrixXd& value);

/// Standard deviation of what rounding to a step does.
double rounding_error(double step);

} // namespace reradiant
