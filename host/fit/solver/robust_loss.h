#pragma once

#include <string>

namespace ceres {
class LossFunction;
}

namespace reradiant {

/// A `RobustLoss` says what a residual of s standard errors costs: s^2 / 2, or less for outliers.
enum class RobustLoss { None, Huber, Cauchy };

/// `none`, `huber` or `cauchy`; input Error otherwise.
RobustLoss robust_loss_from_name(const std::string& name);

/// A new Ceres loss, turning at the 95 % efficient points of Holland and Welsch 1977 (1.345 and
/// 2.385 standard errors); null for None. The caller owns it.
ceres::LossFunction* make_loss(RobustLoss loss);

} // namespace reradiant
