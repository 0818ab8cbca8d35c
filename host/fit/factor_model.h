#pragma once

#include "host/fit/fit_target.h"
#include "host/fit/non_negative_solver.h"
#include "host/fit/photon_penalty.h"
#include "host/fit/robust_loss.h"
#include "host/fit/smooth_basis.h"

namespace reradiant {

/// Model `factors`: entry (o, i) = allowed(o, i) sum_k e_k(o) x_k(i) with e = emission basis times
/// coefficients, x likewise, all coefficients non-negative. One parameter block holds the K
/// coefficients of one basis function: first the emission's, then the excitation's.
class FactorModel final : public NonNegativeModel {
public:
    FactorModel(const FitTarget& target, int rank, const SmoothBasis& emission,
                const SmoothBasis& excitation, const PhotonPenalty& penalty, RobustLoss loss);

    std::vector<int> block_sizes() const override;
    void add_residuals(ceres::Problem& problem, const std::vector<double*>& blocks) const override;
    LinearAlgebra linear_algebra() const override;

    int rank() const { return rank_; }
    const SmoothBasis& emission_basis() const { return emission_; }
    const SmoothBasis& excitation_basis() const { return excitation_; }
    /// Curves on the bands, (emission bands, K) and (excitation bands, K).
    Eigen::MatrixXd emission(const Eigen::VectorXd& parameters) const;
    Eigen::MatrixXd excitation(const Eigen::VectorXd& parameters) const;
    /// The matrix, (emission, excitation), in units of the target's scale.
    Eigen::MatrixXd matrix(const Eigen::VectorXd& parameters) const;
    Eigen::VectorXd parameters(const Eigen::MatrixXd& emission_coefficients,
                               const Eigen::MatrixXd& excitation_coefficients) const;
    /// Coefficients, (functions, K).
    Eigen::MatrixXd emission_coefficients(const Eigen::VectorXd& parameters) const;
    Eigen::MatrixXd excitation_coefficients(const Eigen::VectorXd& parameters) const;
    /// Makes both curves of every term equally long; the matrix stays.
    void balance(Eigen::VectorXd& parameters) const;

private:
    const FitTarget& target_;
    int rank_;
    SmoothBasis emission_, excitation_;
    const PhotonPenalty& penalty_;
    RobustLoss loss_;
};

} // namespace reradiant
