#pragma once

#include "host/fit/data/fit_target.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace reradiant {

/// Costs of the photons that an excitation column emits, sum S in units of the target's scale. Two
/// residuals a column:
/// - the measured diagonal d +- sigma gives way where S + d exceeds 1: max(0, S - spare) / sigma,
///   which is what is left of ((true diagonal - d) / sigma)^2 at its minimum under the balance;
/// - S <= budget by an augmented Lagrangian (Nocedal and Wright 2006, 17.4):
///   max(0, strength (S - budget) + multiplier) / sqrt(strength).
/// Columns that have not exceeded anything yet are left out of the problem.
class PhotonPenalty {
public:
    explicit PhotonPenalty(const FitTarget& target);

    static constexpr int residuals_of_a_column = 2;
    using Residuals = std::array<double, residuals_of_a_column>;

    bool watches(Eigen::Index column) const {
        return is_short_[static_cast<std::size_t>(column)] || strength_(column) > 0.0;
    }
    /// Residuals of a column and their derivatives by the sum.
    Residuals residuals(Eigen::Index column, double sum) const;
    Residuals slopes(Eigen::Index column, double sum) const;
    /// Square sum of the first residuals: how far the diagonal must give way.
    double misfit(const Eigen::VectorXd& sums) const;
    /// After a solve: watches columns that newly exceed something by more than `tolerance` (in the
    /// units of `sums`) and has new multipliers. True when another solve is needed.
    bool update(const Eigen::VectorXd& sums, double first_strength, double tolerance);

private:
    double give_way(Eigen::Index column, double sum) const;

    const FitTarget& target_;
    std::vector<bool> is_short_; ///< the diagonal of the column has to give way
    Eigen::VectorXd strength_, multiplier_;
};

} // namespace reradiant
