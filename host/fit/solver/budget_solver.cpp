#include "host/fit/solver/budget_solver.h"

#include "host/fit/solver/non_negative_solver.h"

#include <algorithm>

namespace reradiant {

namespace {

constexpr double tolerance = 1e-7;
constexpr int most_rounds = 40;

void take_misfit(const FittedModel& model, const FitTarget& target, const PhotonPenalty& penalty,
                 ModelFit& fit) {
    const Eigen::MatrixXd matrix = model.matrix(fit.parameters);
    fit.chi_squared = target.chi_squared(matrix);
    fit.diagonal_misfit = penalty.misfit(target.photon_sums(matrix));
}

} // namespace

ModelFit minimise_within_budget(const FittedModel& model, const FitTarget& target,
                                PhotonPenalty& penalty, const Eigen::VectorXd& start,
                                const SolverSettings& settings,
                                std::chrono::steady_clock::time_point begin) {
    ModelFit fit;
    fit.parameters = start;
    // The penalty is as stiff as the data of a column together, so that the first round is neither
    // deaf nor stuck.
    const double strength = 10.0 * target.weight.squaredNorm() /
                            static_cast<double>(std::max<Eigen::Index>(1, target.value.cols()));
    for (int round = 0; round < most_rounds; ++round) {
        fit.trace.append(minimise_non_negative(model, fit.parameters, settings, begin));
        const Eigen::VectorXd sums = target.photon_sums(model.matrix(fit.parameters));
        // The tolerance is a share of a photon, which is 1 / scale here.
        if (!penalty.update(sums, strength, tolerance / target.scale)) {
            take_misfit(model, target, penalty, fit);
            return fit;
        }
        if (!fit.trace.converged)
            break;
    }
    take_misfit(model, target, penalty, fit);
    if (fit.trace.converged)
        fit.trace.stop_reason = "the photon balance was not reached";
    fit.trace.converged = false;
    return fit;
}

} // namespace reradiant
