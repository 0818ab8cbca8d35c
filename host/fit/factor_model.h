#pragma once

#include "host/fit/fit_target.h"
#include "host/fit/fitted_model.h"
#include "host/fit/photon_penalty.h"
#include "host/fit/robust_loss.h"
#include "host/fit/smooth_basis.h"

namespace reradiant {

/// Model `factors`: entry (o, i) = allowed(o, i) sum_k e_k(o) x_k(i) with e = emission basis times
/// coefficients, x likewise, all coefficients non-negative. One parameter block holds the K
/// coefficients of one basis function: first the emission's, then the excitation's.
class FactorModel final : public TermModel {
public:
    FactorModel(const FitTarget& target, int rank, const SmoothBasis& emission,
                const SmoothBasis& excitation, const PhotonPenalty& penalty, RobustLoss loss);

    std::vector<int> block_sizes() const override;
    void add_residuals(ceres::Problem& problem, const std::vector<double*>& blocks) const override;

    /// The excitation's.
    std::pair<std::size_t, std::size_t> affine_blocks() const override {
        return {static_cast<std::size_t>(emission_.size()),
                static_cast<std::size_t>(excitation_.size())};
    }

    FactorCurves curves(const Eigen::VectorXd& parameters) const override;
    Eigen::MatrixXd matrix(const Eigen::VectorXd& parameters) const override;
    Eigen::MatrixXd entry_jacobian(const Eigen::VectorXd& parameters) const override;
    Eigen::MatrixXd prior_jacobian() const override;
    int terms() const override { return rank_; }
    int term_of(Eigen::Index parameter) const override {
        return static_cast<int>(parameter % rank_);
    }
    int free_units() const override { return 1; }
    /// Coefficients, and where chosen knots lie.
    std::size_t stored_numbers() const override;
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
