#include "host/fit/models/gaussian_fit.h"

#include "host/fit/models/gaussian_model.h"

#include <utility>

namespace reradiant {

namespace {

/// More Gaussians in a row that the evidence is against before none is tried any more: while what
/// is left is noise, and while it is not.
constexpr int patience = 2, patience_beyond_noise = 6;

Eigen::VectorXd with_one_more(const Eigen::VectorXd& parameters, const WavenumberGaussian& one) {
    Eigen::VectorXd more(parameters.size() + 5);
    more << parameters, one.amplitude, one.emission_centre, one.log_emission_width,
        one.excitation_centre, one.log_excitation_width;
    return more;
}

FittedCandidate grown(const FitTarget& target, const FitSettings& settings, Evidence evidence,
                      const Eigen::VectorXd& smaller, std::chrono::steady_clock::time_point begin) {
    FittedCandidate next;
    next.penalty = std::make_unique<PhotonPenalty>(target);
    const auto count = static_cast<int>(smaller.size() / 5);
    const GaussianModel before(target, count, *next.penalty, settings.loss);
    auto model = std::make_unique<GaussianModel>(target, count + 1, *next.penalty, settings.loss);
    const Eigen::VectorXd start =
        with_one_more(smaller, before.largest_excess(target.value - before.matrix(smaller)));
    next.fit = minimise_within_budget(*model, target, *next.penalty, start, settings.solver, begin);
    next.criterion = information_criterion(next.fit.chi_squared, next.fit.parameters.size(),
                                           target.used_count(), evidence);
    next.model = std::move(model);
    return next;
}

} // namespace

FittedCandidate fit_gaussians(const FitTarget& target, const FitSettings& settings,
                              Evidence evidence, std::chrono::steady_clock::time_point begin) {
    FittedCandidate best = dark_candidate(target, evidence);
    Eigen::VectorXd parameters(0);
    int worse = 0;
    for (int count = 1; count <= settings.rank.value_or(largest_gaussian_count); ++count) {
        FittedCandidate next = grown(target, settings, evidence, parameters, begin);
        parameters = next.fit.parameters;
        const bool better = next.criterion < best.criterion && next.fit.trace.converged;
        worse = better ? 0 : worse + 1;
        if (settings.rank || better)
            best = std::move(next);
        if (!settings.rank && worse > patience &&
            (worse > patience_beyond_noise || residuals_are_noise(best, target)))
            break;
    }
    return best;
}

} // namespace reradiant
