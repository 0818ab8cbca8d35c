#pragma once

#include "reradiant/fit.h"

namespace ceres {
class LossFunction;
}

namespace reradiant {

/// A new Ceres loss, turning at the 95 % efficient points of Holland and Welsch 1977 (1.345 and
/// 2.385 standard errors); null for None. The caller owns it.
ceres::LossFunction* make_loss(RobustLoss loss);

} // namespace reradiant
