#pragma once

#include "host/fit/solver/budget_solver.h"

#include <limits>
#include <memory>
#include <vector>

namespace reradiant {

/// `Evidence` says what is known of the noise when models are compared.
enum class Evidence {
    KnownNoise,    ///< standard errors came with the data
    EstimatedNoise ///< they were estimated, so their scale is uncertain, too
};

/// Schwarz's criterion (1978), -2 log evidence up to a constant: chi^2 + p log n, or with the
/// noise's scale integrated out 2 n log(1 + chi^2 / n) + p log n, where the estimate counts as much
/// as the data. Lower is better.
double information_criterion(double chi_squared, Eigen::Index parameters, Eigen::Index data,
                             Evidence evidence);

/// -2 log evidence of a model with a proper prior, up to a constant of the data (Laplace's method:
/// MacKay 1992, Neural Computation 4, 415): misfit as above plus the prior's, plus the logarithm of
/// how much narrower the posterior is than the prior. A parameter at zero that is pushed against it
/// by a slope g has the integral of exp(-g x - h x^2 / 2) over x > 0 for its width. Lower is
/// better.
double laplace_criterion(const TermModel& model, const ModelFit& fit, const FitTarget& target,
                         Evidence evidence);

/// A model after its fit. A null model stands for no fluorescence.
struct FittedCandidate {
    std::unique_ptr<PhotonPenalty> penalty; ///< the model refers to it
    std::unique_ptr<TermModel> model;
    ModelFit fit;
    double criterion = std::numeric_limits<double>::infinity();
    double spacing_nm = 0.0;
    std::vector<int> emission_knots, excitation_knots; ///< see FitResult
};

/// Largest reduced chi squared of noise that was estimated from the data, with the error that such
/// an estimate has.
inline constexpr double largest_reduced_chi_squared = 2.0;

/// Data less the numbers that they determine rather than a prior; at least 1.
double degrees_of_freedom(const FittedCandidate& candidate, const FitTarget& target);

/// Returns true when residuals may be noise: they are no larger than it, or their reduced chi
/// squared is at most largest_reduced_chi_squared, or five standard deviations above 1 for so many
/// degrees of freedom.
bool residuals_are_noise(double chi_squared, double data, double freedom);
/// Returns true when the residuals of a candidate may be noise, with limits lower by a tenth, so
/// that one that passes is not refused in the end.
bool residuals_are_noise(const FittedCandidate& candidate, const FitTarget& target);

/// No fluorescence at all: what every model is compared with.
FittedCandidate dark_candidate(const FitTarget& target, Evidence evidence);

} // namespace reradiant
