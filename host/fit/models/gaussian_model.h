#pragma once

#include "host/fit/data/fit_target.h"
#include "host/fit/models/fitted_model.h"
#include "host/fit/models/photon_penalty.h"
#include "host/fit/solver/robust_loss.h"

namespace reradiant {

/// One Gaussian over the plane of wavenumbers, in 1/um: axes along emission and excitation, as
/// emission does not depend on what excited it (Kasha's rule).
struct WavenumberGaussian {
    double amplitude; ///< in units of the target's scale
    double emission_centre, log_emission_width, excitation_centre, log_excitation_width;
};

/// Model `gaussians`: entry = allowed * sum of Gaussians, cut off at the diagonal. One block of
/// five numbers a Gaussian, in the order above; amplitudes are not negative. A prior as weak as one
/// standard error keeps centres on the grid and widths near 0.1/um when nothing else does.
class GaussianModel final : public TermModel {
public:
    GaussianModel(const FitTarget& target, int count, const PhotonPenalty& penalty,
                  RobustLoss loss);

    std::vector<int> block_sizes() const override;
    bool may_be_negative(Eigen::Index parameter) const override { return parameter % 5 != 0; }
    void add_residuals(ceres::Problem& problem, const std::vector<double*>& blocks) const override;
    Eigen::MatrixXd matrix(const Eigen::VectorXd& parameters) const override;
    std::size_t stored_numbers() const override { return 5 * static_cast<std::size_t>(count_); }
    int terms() const override { return count_; }
    int term_of(Eigen::Index parameter) const override { return static_cast<int>(parameter / 5); }
    FactorCurves curves(const Eigen::VectorXd& parameters) const override;
    Eigen::MatrixXd entry_jacobian(const Eigen::VectorXd& parameters) const override;
    int free_units() const override { return 0; }

    /// A new Gaussian where a residual (data - model) is largest once it is smoothed.
    WavenumberGaussian largest_excess(const Eigen::MatrixXd& residual) const;

private:
    const FitTarget& target_;
    int count_;
    const PhotonPenalty& penalty_;
    RobustLoss loss_;
};

} // namespace reradiant
