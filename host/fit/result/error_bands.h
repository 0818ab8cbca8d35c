#pragma once

#include "host/fit/result/quantum_yield.h"
#include "host/fit/result/shared_errors.h"
#include "host/fit/solver/budget_solver.h"
#include "reradiant/fit.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// Gauss-Newton covariance of parameters, root * root^T.
struct Covariance {
    Eigen::MatrixXd root;   ///< (parameters, rank); rows of held parameters are zero
    int rank = 0;           ///< directions that the data determine
    int free = 0;           ///< parameters that were not held
    double effective = 0.0; ///< numbers that the data determine rather than a prior
    /// Errors of the data's diagonal that belong to the columns of `root`, (excitation bands,
    /// rank), unit 1; empty: they are independent of the parameters'.
    Eigen::MatrixXd diagonal_root = {};

    /// Standard errors of quantities with this Jacobian (quantities, parameters).
    Eigen::VectorXd sigma(const Eigen::MatrixXd& jacobian) const;
};

/// variance * (J^T J)^+ from the singular values of J with its columns scaled to length 1. What is
/// below 1e-7 of the largest one is not determined and left out: SPARSE_QR would report variances
/// of 2e14 there (case 50 of tests/README.md). jacobian: (residuals, parameters), weighted.
Covariance covariance_of(const Eigen::MatrixXd& jacobian, const std::vector<bool>& held,
                         double variance);

/// Parameters at zero that the data push against zero by more than two standard errors. gradient:
/// of half the square sum; jacobian: (residuals, parameters), weighted.
std::vector<bool> firmly_at_zero(const NonNegativeModel& model, const Eigen::VectorXd& parameters,
                                 const Eigen::VectorXd& gradient, const Eigen::MatrixXd& jacobian);

/// Covariance of a model at its optimum. Parameters at zero that the data push against zero by more
/// than two standard errors are held; those that are there by chance are not, so that their error
/// bands are not empty. Active photon balances count as data, priors as they are: what the data do
/// not determine is as uncertain as its prior. `free` and `rank` are of the data alone. With
/// `errors` those of the entries are shared, not independent as the weights suppose (White 1980);
/// with_diagonal asks for `diagonal_root` then.
Covariance covariance_at(const TermModel& model, const ModelFit& fit, const FitTarget& target,
                         const PhotonPenalty& penalty, RobustLoss loss, bool noise_is_estimated,
                         const SharedErrors* errors, bool with_diagonal = false);

/// Normalised curves of a model and their errors (FitResult); unit 1/nm and 1.
struct NormalisedCurves {
    FittedCurves emission, excitation;
};
NormalisedCurves normalised_curves(const TermModel& model, const Eigen::VectorXd& parameters,
                                   const Covariance& covariance, const FitTarget& target);

/// Returns the photons that every term emits, with errors from the covariance. `jacobian` is the
/// model's entry_jacobian.
EmittedPhotons emitted_photons(const TermModel& model, const Eigen::VectorXd& parameters,
                               const Eigen::MatrixXd& jacobian, const Covariance& covariance,
                               const FitTarget& target);

} // namespace reradiant
