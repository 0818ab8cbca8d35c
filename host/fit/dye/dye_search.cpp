#include "host/fit/dye/dye_search.h"

#include "host/fit/dye/dye_start.h"
#include "host/fit/models/model_selection.h"
#include "host/fit/solver/bounded_quadratic.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;
using Clock = std::chrono::steady_clock;

/// Depths that tables reach to at first, and at most: deeper layers look alike.
constexpr double first_largest_depth = 8.0, last_largest_depth = 20.0;

/// Steps after which it is seen which bands the data say nothing of; with these a fit takes
/// hundreds more.
constexpr int steps_before_judging = 25;

/// Rounding of the tables may keep the cost from falling before the conditions of a minimum
/// hold to all digits. It is one where no step would lower the cost by what noise does not
/// notice.
void judge_convergence(DyeCandidate& candidate) {
    constexpr double unnoticed = 1e-3, damping = 1e-9;
    if (candidate.trace.converged)
        return;
    Vector residual;
    Matrix jacobian;
    const DyeModel& model = *candidate.model;
    model.evaluate(candidate.packed, residual, &jacobian);
    const Vector gradient = jacobian.transpose() * residual;
    Quadratic<Matrix> quadratic{jacobian.transpose() * jacobian, {}};
    for (Index k = 0; k < gradient.size(); ++k) // one that nothing depends on stays
        quadratic.h(k, k) += quadratic.h(k, k) > 0.0 ? damping * quadratic.h(k, k) : 1.0;
    quadratic.c = gradient - quadratic.h * candidate.packed;
    const auto count = static_cast<std::size_t>(gradient.size());
    std::vector<bool> free(count);
    for (std::size_t k = 0; k < count; ++k)
        free[k] = candidate.packed(static_cast<Index>(k)) > 0.0;
    const auto end = minimise_quadratic(quadratic, std::vector<bool>(count, true), free);
    if (!end)
        return;
    const Vector step = *end - candidate.packed;
    const double gain = -gradient.dot(step) - 0.5 * step.dot(quadratic.h * step);
    if (gain > unnoticed)
        return;
    candidate.trace.converged = true;
    candidate.trace.stop_reason =
        fmt::format("no step lowers the cost by more than {:.1e}", std::max(gain, 0.0));
}

} // namespace

DyeSearch::DyeSearch(const std::vector<BispectralData>& data, const DyeFitSettings& settings)
    : settings_(settings), begin_(Clock::now()),
      prepared_(prepare_dyes(data, settings, first_largest_depth)) {
    is_estimated_ = std::ranges::all_of(prepared_.sets, &DyeDataSet::noise_is_estimated);
}

double DyeSearch::seconds() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
}

DyeCandidate DyeSearch::best(std::vector<DyeEvidence>& evidence) {
    DyeCandidate best;
    const int first = settings_.dyes.value_or(1), last = settings_.dyes.value_or(most_fitted_dyes);
    for (int dyes = first; dyes <= last; ++dyes) {
        DyeCandidate next = fitted(dyes);
        evidence.push_back(next.evidence);
        const bool is_better = !best.model || (next.trace.converged &&
                                               next.evidence.criterion < best.evidence.criterion);
        if (!is_better)
            break;
        best = std::move(next);
    }
    return best;
}

DyeCandidate DyeSearch::fitted(int dyes) {
    DyeProblem& problem = prepared_.problem;
    const WavelengthGrid& emission = prepared_.sets.front().data.emission;
    const double spacing = settings_.smooth_nm.value_or(0.0);
    DyeCandidate candidate;
    candidate.model = std::make_unique<DyeModel>(problem, spline_basis(problem.bands, spacing),
                                                 spline_basis(emission, spacing), dyes);
    DyeModel& model = *candidate.model;
    const DyeParameters start = dye_start(problem, dyes, settings_.solver);
    model.keep_unit(start.emission);
    candidate.packed = model.packed(start);
    minimise(candidate, steps_before_judging);
    hold_what_is_unseen(candidate, DyeSpectrum::Emission);
    hold_what_is_unseen(candidate, DyeSpectrum::Absorption);
    while (reaches_beyond_tables(candidate)) {
        const double depth = problem.samples.front().stack->largest_depth();
        set_largest_depth(prepared_, settings_, std::min(last_largest_depth, 2.5 * depth));
        minimise(candidate);
    }
    hold_yields_at_one(candidate);
    judge(candidate);
    return candidate;
}

void DyeSearch::minimise(DyeCandidate& candidate, int most_iterations) {
    SolverSettings solver = settings_.solver;
    solver.most_iterations = std::min(solver.most_iterations, most_iterations);
    candidate.trace.append(
        minimise_non_negative(*candidate.model, candidate.packed, solver, begin_));
}
void DyeSearch::minimise(DyeCandidate& candidate) {
    minimise(candidate, settings_.solver.most_iterations);
}

bool DyeSearch::reaches_beyond_tables(const DyeCandidate& candidate) const {
    constexpr double near = 0.8;
    const DyeProblem& problem = prepared_.problem;
    const Vector all = candidate.model->parameters(candidate.packed).absorption.rowwise().sum();
    return problem.samples.front().stack->largest_depth() < last_largest_depth &&
           all.maxCoeff() > near * problem.largest_absorption();
}

/// No dye sends out more photons than it takes.
void DyeSearch::hold_yields_at_one(DyeCandidate& candidate) {
    for (int round = 0; round < candidate.model->dyes(); ++round) {
        const Index first = candidate.model->places().quantum_yield;
        bool is_held = false;
        for (Index dye = 0; dye < candidate.model->dyes(); ++dye)
            if (double& yield = candidate.packed(first + dye); yield > 1.0) {
                yield = 1.0;
                candidate.model->hold(first + dye);
                is_held = true;
            }
        if (!is_held)
            return;
        minimise(candidate);
    }
}

/// What the data do not show is taken as dark, with its error, where that fits as well.
void DyeSearch::hold_what_is_unseen(DyeCandidate& candidate, DyeSpectrum which) {
    constexpr double as_well = 4.0; // rise of chi squared a number
    const Vector sigma = dye_covariance(*candidate.model, candidate.packed, is_estimated_).sigma;
    const std::vector<Index> unseen =
        unseen_coefficients(*candidate.model, which, candidate.packed, sigma);
    if (candidate.unseen.size() == 0)
        candidate.unseen = Vector::Zero(sigma.size());
    if (unseen.empty())
        return;
    const double limit = candidate.model->chi_squared(candidate.packed) +
                         as_well * static_cast<double>(unseen.size());
    const DyeModel all = *candidate.model;
    const Vector before = candidate.packed, unseen_before = candidate.unseen;
    for (const Index k : unseen) {
        candidate.packed(k) = 0.0;
        candidate.unseen(k) = sigma(k);
        candidate.model->hold(k);
    }
    minimise(candidate);
    if (candidate.model->chi_squared(candidate.packed) <= limit)
        return;
    *candidate.model = all;
    candidate.packed = before;
    candidate.unseen = unseen_before;
    minimise(candidate);
}

void DyeSearch::judge(DyeCandidate& candidate) const {
    judge_convergence(candidate);
    const DyeModel& model = *candidate.model;
    const Index data = prepared_.problem.used_count();
    DyeEvidence& evidence = candidate.evidence;
    evidence.dyes = model.dyes();
    evidence.chi_squared = model.chi_squared(candidate.packed);
    // of an emission one number is its unit
    evidence.parameters = static_cast<int>((candidate.packed.array() > 0.0).count()) - model.dyes();
    evidence.criterion =
        information_criterion(evidence.chi_squared, evidence.parameters, data,
                              is_estimated_ ? Evidence::EstimatedNoise : Evidence::KnownNoise);
    evidence.converged = candidate.trace.converged;
}

} // namespace reradiant
