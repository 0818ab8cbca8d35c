#include "host/fit/factors/factor_fit.h"

#include "host/fit/factors/hidden_bands.h"
#include "host/fit/factors/knot_choice.h"
#include "host/fit/models/run_in_parallel.h"
#include "host/fit/solver/solve_journal.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace reradiant {

namespace {

using Clock = std::chrono::steady_clock;

/// Steps that each start is given at first.
constexpr int first_steps = 12;
/// Fewest knots of a term, over both its curves.
constexpr std::size_t fewest_knots = 4;

/// Functions of both curves.
struct CurveBases {
    SmoothBasis emission, excitation;
};

/// Evidence that more terms must have: a Bayes factor of more than e^5, very strong (Kass and
/// Raftery 1995).
constexpr double very_strong = 10.0;

/// One minimisation from one start.
struct FactorTask {
    int rank;
    const CurveBases& bases;
    double bend_width;
    FactorCurves start;
    Eigen::VectorXd parameters = {}; ///< instead of a start, of an earlier fit
};

class FactorFitter {
public:
    FactorFitter(const FitTarget& target, const FitSettings& settings, Clock::time_point begin)
        : target_(target), settings_(settings), begin_(begin) {}

    /// The best fit from several starts: that which is ahead after some steps goes on, and if it
    /// does not end, the next one.
    FittedCandidate fit(int rank, const CurveBases& bases, double bend_width,
                        std::vector<FactorCurves> starts) const {
        std::vector<FactorTask> tasks;
        for (FactorCurves& start : starts)
            tasks.push_back({rank, bases, bend_width, std::move(start)});
        if (tasks.size() == 1)
            return std::move(fit_all(tasks, settings_.solver).front());
        SolverSettings solver = settings_.solver;
        solver.most_iterations = std::min(solver.most_iterations, first_steps);
        std::vector<FittedCandidate> fits = fit_all(tasks, solver);
        std::stable_sort(fits.begin(), fits.end(), [](const auto& a, const auto& b) {
            return a.fit.chi_squared < b.fit.chi_squared;
        });
        for (FittedCandidate& fit : fits) {
            if (!fit.fit.trace.converged)
                go_on(rank, bases, bend_width, fit);
            if (fit.fit.trace.converged)
                return std::move(fit);
        }
        return std::move(fits.front());
    }

    /// Fits that do not depend on each other, in the order of the tasks.
    std::vector<FittedCandidate> fit_all(const std::vector<FactorTask>& tasks,
                                         const SolverSettings& solver) const {
        std::vector<SolverSettings> solvers(tasks.size(), solver);
        for (SolverSettings& mine : solvers)
            if (solver.journal != nullptr)
                mine.journal = &solver.journal->branch();
        std::vector<FittedCandidate> fits(tasks.size());
        run_in_parallel(settings_.threads, tasks.size(),
                        [&](std::size_t k) { fits[k] = fit_from(tasks[k], solvers[k]); });
        return fits;
    }

    CurveBases splines(double spacing_nm) const {
        return {spline_basis(target_.emission, spacing_nm),
                spline_basis(target_.excitation, spacing_nm)};
    }

    /// The fit with curves that are linear between as many bands as some bytes hold.
    FittedCandidate within(std::size_t bytes, FittedCandidate full) const {
        if (!full.model || 4 * full.model->stored_numbers() <= bytes)
            return full;
        const int rank = full.model->terms();
        const std::size_t numbers = bytes / 4, positions = numbers_of_positions(target_);
        const auto terms = static_cast<std::size_t>(rank);
        if (numbers < positions + fewest_knots * terms)
            throw_input_error(
                {}, fmt::format("--bytes {} is too small for {} terms", bytes, rank),
                fmt::format("give at least {}", 4 * (positions + fewest_knots * terms)));
        const FactorCurves curves = full.model->curves(full.fit.parameters);
        const CurveKnots knots = choose_knots(target_, curves, (numbers - positions) / terms);
        const CurveBases bases{hat_basis(target_.emission, knots.emission),
                               hat_basis(target_.excitation, knots.excitation)};
        // Knots are not evenly spaced: bends have no prior.
        return fit(rank, bases, FactorModel::bend_of_lines, {curves});
    }

    std::vector<FactorCurves> starts(int rank, const FactorCurves& smaller) const {
        return factor_starts(target_, rank, smaller, settings_.starts, settings_.seed,
                             settings_.threads);
    }

    const SolverSettings& solver() const { return settings_.solver; }

    FactorCurves no_curves() const {
        return {Eigen::MatrixXd(target_.value.rows(), 0), Eigen::MatrixXd(target_.value.cols(), 0)};
    }

private:
    void go_on(int rank, const CurveBases& bases, double bend_width,
               FittedCandidate& candidate) const {
        SolveTrace trace = std::move(candidate.fit.trace);
        const FactorTask rest{rank, bases, bend_width, {}, candidate.fit.parameters};
        candidate = std::move(fit_all({rest}, settings_.solver).front());
        trace.append(candidate.fit.trace);
        candidate.fit.trace = std::move(trace);
    }

    FittedCandidate fit_from(const FactorTask& task, const SolverSettings& solver) const {
        const auto& [emission, excitation] = task.bases;
        FittedCandidate candidate;
        candidate.penalty = std::make_unique<PhotonPenalty>(target_);
        auto model =
            std::make_unique<FactorModel>(target_, task.rank, emission, excitation,
                                          *candidate.penalty, settings_.loss, task.bend_width);
        Eigen::VectorXd parameters = task.parameters;
        if (parameters.size() == 0)
            parameters = model->parameters(coefficients_near(emission, task.start.emission),
                                           coefficients_near(excitation, task.start.excitation));
        model->balance(parameters);
        candidate.fit =
            minimise_within_budget(*model, target_, *candidate.penalty, parameters, solver, begin_);
        model->balance(candidate.fit.parameters);
        candidate.model = std::move(model);
        candidate.spacing_nm = emission.spacing_nm;
        candidate.emission_knots = emission.knots;
        candidate.excitation_knots = excitation.knots;
        return candidate;
    }

    const FitTarget& target_;
    const FitSettings& settings_;
    Clock::time_point begin_;
};

FactorCurves curves_of(const FittedCandidate& candidate) {
    return candidate.model->curves(candidate.fit.parameters);
}

/// The fit of some terms with the width that the evidence is for.
FittedCandidate by_width(const FitTarget& target, const FactorFitter& fitter,
                         const CurveBases& bases, Evidence evidence, int rank,
                         const FactorCurves& smaller) {
    constexpr double narrow = FactorModel::bend_of_bands;
    constexpr double wider[] = {2.0 * narrow, FactorModel::bend_of_lines};
    FittedCandidate best = fitter.fit(rank, bases, narrow, fitter.starts(rank, smaller));
    std::vector<FactorTask> tasks;
    for (const double width : wider)
        tasks.push_back({rank, bases, width, curves_of(best)});
    std::vector<FittedCandidate> fits = fitter.fit_all(tasks, fitter.solver());
    const auto criterion_of = [&](const FittedCandidate& fit) {
        return laplace_criterion(*fit.model, fit.fit, target, evidence);
    };
    // Few data hardly tell the widths apart, but a prior must not keep the curves off the data.
    const auto keeps_off = [&](const FittedCandidate& fit) {
        return fit.fit.chi_squared > largest_reduced_chi_squared * degrees_of_freedom(fit, target);
    };
    best.criterion = criterion_of(best);
    for (FittedCandidate& fit : fits) {
        fit.criterion = criterion_of(fit);
        const bool is_better =
            keeps_off(fit) == keeps_off(best) ? fit.criterion < best.criterion : keeps_off(best);
        if (fit.fit.trace.converged && is_better)
            best = std::move(fit);
    }
    return best;
}

/// Returns true when a candidate explains what another, whose residuals are not noise, does not:
/// then the evidence, which takes residuals for noise, is no judge.
bool leaves_clearly_less(const FittedCandidate& candidate, const FittedCandidate& other,
                         const FitTarget& target) {
    constexpr double clearly = 0.8;
    const auto reduced = [&](const FittedCandidate& fit) {
        return fit.fit.chi_squared / degrees_of_freedom(fit, target);
    };
    return residuals_are_noise(candidate, target) || reduced(candidate) < clearly * reduced(other);
}

/// Terms are added while the evidence for them is very strong, or while what they leave is not
/// noise: two may help where one cannot. The width of the prior of a term's bends is chosen by
/// evidence, too. No splines: what they cannot bend to is not in the error
/// bands, which held 77 to 92 % of the truth where the evidence or chi squared was for them.
FittedCandidate by_evidence(const FitTarget& target, const FactorFitter& fitter,
                            const CurveBases& bases, Evidence evidence) {
    FittedCandidate best = dark_candidate(target, evidence);
    FactorCurves smaller = fitter.no_curves();
    for (int rank = 1; rank <= largest_factor_rank; ++rank) {
        FittedCandidate next = by_width(target, fitter, bases, evidence, rank, smaller);
        smaller = curves_of(next);
        const bool is_done = residuals_are_noise(best, target);
        if (next.criterion < best.criterion - very_strong ||
            (!is_done && leaves_clearly_less(next, best, target)))
            best = std::move(next);
        else if (is_done)
            break;
    }
    return best;
}

/// A fit with values for bands that the data say next to nothing about.
FittedCandidate bridged(const FitTarget& target, FittedCandidate candidate) {
    if (!candidate.model || candidate.spacing_nm > 0.0)
        return candidate;
    FactorCurves curves = curves_of(candidate);
    bridge_hidden_bands(target, curves);
    candidate.fit.parameters =
        static_cast<FactorModel&>(*candidate.model).parameters(curves.emission, curves.excitation);
    return candidate;
}

} // namespace

FittedCandidate fit_factors(const FitTarget& target, const FitSettings& settings, Evidence evidence,
                            Clock::time_point begin) {
    const FactorFitter fitter(target, settings, begin);
    const CurveBases bases = fitter.splines(settings.smooth_nm.value_or(0.0));
    const std::size_t most_bytes =
        settings.most_bytes.value_or(std::numeric_limits<std::size_t>::max());
    if (settings.rank) {
        FactorCurves smaller = fitter.no_curves();
        for (int rank = 1; rank < *settings.rank; ++rank)
            smaller = fitter.starts(rank, smaller).front();
        FittedCandidate full = fitter.fit(*settings.rank, bases, FactorModel::bend_of_lines,
                                          fitter.starts(*settings.rank, smaller));
        return fitter.within(most_bytes, bridged(target, std::move(full)));
    }
    return fitter.within(most_bytes, bridged(target, by_evidence(target, fitter, bases, evidence)));
}

} // namespace reradiant
