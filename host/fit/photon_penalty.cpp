#include "host/fit/photon_penalty.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

double PhotonPenalty::residual(Eigen::Index column, double excess) const {
    return std::max(0.0, strength(column) * excess + multiplier(column)) /
           std::sqrt(strength(column));
}

double PhotonPenalty::slope(Eigen::Index column, double excess) const {
    return strength(column) * excess + multiplier(column) > 0.0 ? std::sqrt(strength(column)) : 0.0;
}

bool PhotonPenalty::update(const Eigen::VectorXd& sums, const Eigen::VectorXd& budget,
                           double first_strength, double tolerance) {
    bool violated = false;
    for (Eigen::Index i = 0; i < sums.size(); ++i) {
        const double excess = sums(i) - budget(i);
        const bool over = excess > tolerance;
        violated = violated || over;
        if (strength(i) > 0.0) {
            multiplier(i) = std::max(0.0, multiplier(i) + strength(i) * excess);
            if (over)
                strength(i) *= 4.0;
        } else if (over) {
            strength(i) = first_strength;
        }
    }
    return violated;
}

} // namespace reradiant
