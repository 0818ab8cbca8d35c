#include "host/fit/solver/robust_loss.h"

#include "reradiant/error.h"

#include <ceres/loss_function.h>
#include <fmt/core.h>

namespace reradiant {

RobustLoss robust_loss_from_name(const std::string& name) {
    if (name == "none")
        return RobustLoss::None;
    if (name == "huber")
        return RobustLoss::Huber;
    if (name == "cauchy")
        return RobustLoss::Cauchy;
    throw_input_error({}, fmt::format("--loss {} is not known", name),
                      "write none, huber or cauchy");
}

ceres::LossFunction* make_loss(RobustLoss loss) {
    switch (loss) {
    case RobustLoss::Huber:
        return new ceres::HuberLoss(1.345);
    case RobustLoss::Cauchy:
        return new ceres::CauchyLoss(2.385);
    case RobustLoss::None:
        break;
    }
    return nullptr;
}

} // namespace reradiant
