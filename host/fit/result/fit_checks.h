#pragma once

#include "host/fit/data/prepared_target.h"
#include "reradiant/fit.h"

namespace reradiant {

/// The measured diagonal, lowered where the fluorescent part of `matrix`, whose diagonal is zero,
/// leaves less of the energy or of the photons; NaN: not measured.
Eigen::VectorXd balanced_diagonal(const PreparedTarget& prepared, const ReradiationMatrix& matrix);

/// The data's balanced diagonal into a result; gaps between measured bands are bridged by straight
/// lines. Notes say both.
void pass_diagonal(const PreparedTarget& prepared, FitResult& result);

/// Error figures of the model against the data, as `fit --json` has them.
void measure_errors(const PreparedTarget& prepared, FitResult& result);

/// Adds to the standard errors what rounding does to neighbouring entries alike: a fit does not
/// average it out.
void add_rounding(const PreparedTarget& prepared, FitResult& result);

/// Sets the reduced chi squared, and `shortfall` where what the model leaves of the data is more
/// than noise; not with a robust loss, which is for data that hold what no model follows. Residuals
/// that are noise as far as an estimate of it is known make the estimate better: `noise` becomes
/// larger where they are.
void judge_residuals(const PreparedTarget& prepared, const FitSettings& settings,
                     double chi_squared, double freedom, FitResult& result);

/// Finite, non-negative entries and convergence, no energy at impossible places, energy and photon
/// balance, looked at with fresh eyes. Sets anti_stokes_energy, and `failure` to the first thing
/// that is wrong.
void check_fit(FitResult& result);

} // namespace reradiant
