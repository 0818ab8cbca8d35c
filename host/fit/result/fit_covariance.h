#pragma once

#include "host/fit/data/prepared_target.h"
#include "host/fit/result/error_bands.h"
#include "reradiant/fit.h"

namespace reradiant {

/// Directions of the fluorescent part that the uncertainty of a model's parameters moves it in, and
/// with them the diagonal where the two share errors. One more direction is the bias of parameters
/// that cannot be negative: what noise makes of a zero is positive on average, in all dark bands
/// alike. `jacobian` is the model's entry_jacobian.
MatrixCovariance covariance_of_model(const TermModel& model, const Eigen::VectorXd& parameters,
                                     const Eigen::MatrixXd& jacobian, const Covariance& covariance,
                                     const FitTarget& target);

/// Adds the errors of a result's diagonal and of rounding to its covariance, which is none where
/// there is no model, marks what is unknown, and brings it to fewer directions. The result's matrix
/// and sigma are complete.
void finish_covariance(const PreparedTarget& prepared, FitResult& result);

} // namespace reradiant
