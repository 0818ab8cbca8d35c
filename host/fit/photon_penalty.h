#pragma once

#include <Eigen/Core>

namespace reradiant {

/// Augmented Lagrangian (Nocedal and Wright 2006, 17.4) of "photon sum of column i <= budget(i)":
/// a column costs half of max(0, strength (sum - budget) + multiplier)^2 / strength. Columns of
/// strength 0 are left out of the problem.
struct PhotonPenalty {
    Eigen::VectorXd strength, multiplier;

    explicit PhotonPenalty(Eigen::Index columns = 0)
        : strength(Eigen::VectorXd::Zero(columns)), multiplier(Eigen::VectorXd::Zero(columns)) {}
    bool is_active() const { return (strength.array() > 0.0).any(); }
    /// Residual of one column and its derivative by the sum.
    double residual(Eigen::Index column, double excess) const;
    double slope(Eigen::Index column, double excess) const;
    /// After a solve: new multipliers, and a strength for columns that newly exceed their budget.
    /// True when some column exceeds it by more than `tolerance` (in the units of `sums`).
    bool update(const Eigen::VectorXd& sums, const Eigen::VectorXd& budget, double first_strength,
                double tolerance);
};

} // namespace reradiant
