#include "host/fit/models/photon_penalty.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

PhotonPenalty::PhotonPenalty(const FitTarget& target)
    : target_(target), is_short_(static_cast<std::size_t>(target.value.cols()), false),
      strength_(Eigen::VectorXd::Zero(target.value.cols())), multiplier_(strength_) {}

double PhotonPenalty::give_way(Eigen::Index column, double sum) const {
    return std::max(0.0, sum - target_.spare(column)) * target_.spare_weight(column);
}

PhotonPenalty::Residuals PhotonPenalty::residuals(Eigen::Index column, double sum) const {
    Residuals both{};
    if (is_short_[static_cast<std::size_t>(column)])
        both[0] = give_way(column, sum);
    const double strength = strength_(column);
    if (strength > 0.0)
        both[1] = std::max(0.0, strength * (sum - target_.budget(column)) + multiplier_(column)) /
                  std::sqrt(strength);
    return both;
}

PhotonPenalty::Residuals PhotonPenalty::slopes(Eigen::Index column, double sum) const {
    const Residuals at = residuals(column, sum);
    return {at[0] > 0.0 ? target_.spare_weight(column) : 0.0,
            at[1] > 0.0 ? std::sqrt(strength_(column)) : 0.0};
}

double PhotonPenalty::misfit(const Eigen::VectorXd& sums) const {
    double squares = 0.0;
    for (Eigen::Index i = 0; i < sums.size(); ++i)
        squares += std::pow(give_way(i, sums(i)), 2);
    return squares;
}

bool PhotonPenalty::update(const Eigen::VectorXd& sums, double first_strength, double tolerance) {
    bool again = false;
    for (Eigen::Index i = 0; i < sums.size(); ++i) {
        if (target_.spare_weight(i) > 0.0 && !is_short_[static_cast<std::size_t>(i)] &&
            sums(i) > target_.spare(i) + tolerance)
            again = is_short_[static_cast<std::size_t>(i)] = true;
        const double excess = sums(i) - target_.budget(i);
        const bool over = excess > tolerance;
        again = again || over;
        if (strength_(i) > 0.0) {
            multiplier_(i) = std::max(0.0, multiplier_(i) + strength_(i) * excess);
            if (over)
                strength_(i) *= 4.0;
        } else if (over) {
            strength_(i) = first_strength;
        }
    }
    return again;
}

} // namespace reradiant
