#pragma once

#include "host/fit/data/fit_target.h"
#include "host/fit/models/fitted_model.h"
#include "host/fit/models/photon_penalty.h"
#include "host/fit/solver/robust_loss.h"

#include <Eigen/SparseCore>

#include <vector>

namespace reradiant {

/// Precisions of the smoothness prior: of second differences along emission and along excitation,
/// and of the entries themselves (which only keeps the prior proper).
struct Smoothness {
    double emission = 1.0, excitation = 1.0, entry = 1e-2;
};

/// One row of the prior: entries and factors.
struct SmoothnessRow {
    std::vector<Eigen::Index> parameters;
    std::vector<double> factors; ///< already times the root of the precision
};

/// Model `matrix`: every entry where emission is allowed, column by column, with a smoothness
/// prior.
class MatrixModel final : public FittedModel {
public:
    MatrixModel(const FitTarget& target, const Smoothness& smoothness, const PhotonPenalty& penalty,
                RobustLoss loss);

    std::vector<int> block_sizes() const override;
    void add_residuals(ceres::Problem& problem, const std::vector<double*>& blocks) const override;
    LinearAlgebra linear_algebra() const override { return {LinearAlgebra::Type::SparseNormal}; }
    Eigen::MatrixXd matrix(const Eigen::VectorXd& parameters) const override;
    std::size_t stored_numbers() const override { return static_cast<std::size_t>(count_); }

    Eigen::Index count() const { return count_; }
    /// Parameter of an entry, -1 where emission is not allowed.
    Eigen::Index parameter_of(Eigen::Index emission, Eigen::Index excitation) const {
        return index_(emission, excitation);
    }
    /// Data of every parameter, as value and weight.
    Eigen::VectorXd values() const { return gathered(target_.value); }
    Eigen::VectorXd weights() const { return gathered(target_.weight); }
    Eigen::VectorXd gathered(const Eigen::MatrixXd& entries) const;
    /// Precision of the prior, (parameters, parameters).
    Eigen::SparseMatrix<double> prior() const;

private:
    const FitTarget& target_;
    const PhotonPenalty& penalty_;
    RobustLoss loss_;
    Eigen::Matrix<Eigen::Index, Eigen::Dynamic, Eigen::Dynamic> index_;
    Eigen::Index count_ = 0;
    std::vector<SmoothnessRow> rows_;
};

} // namespace reradiant
