#include "host/fit/factor_fit.h"

#include "host/error.h"
#include "host/fit/hidden_bands.h"
#include "host/fit/knot_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace reradiant {

namespace {

using Clock = std::chrono::steady_clock;

/// Spline spacings that the evidence chooses from, in steps of the grid, beside one number a band.
constexpr double spacings_in_steps[] = {1.5, 2.0, 3.0};
/// Steps that each start is given at first: nearly all end in half as many; otherwise the best of
/// them goes on, and if that does not end, the best that did is the answer.
constexpr int first_steps = 80;
/// Of both curves of a term.
constexpr std::size_t fewest_knots = 4;

/// Functions of both curves.
struct CurveBases {
    SmoothBasis emission, excitation;
};

/// One number a term is only a choice of unit; numbers at zero were not needed.
double needed_numbers(const FittedCandidate& candidate) {
    return static_cast<double>((candidate.fit.parameters.array() > 0.0).count()) -
           candidate.model->terms();
}

class FactorFitter {
public:
    FactorFitter(const FitTarget& target, const FitSettings& settings, Clock::time_point begin)
        : target_(target), settings_(settings), begin_(begin) {}

    /// From now on; lines to begin with.
    void set_bend_width(double width) { bend_width_ = width; }

    FittedCandidate fit(int rank, const CurveBases& bases,
                        const std::vector<FactorCurves>& starts) {
        SolverSettings solver = settings_.solver;
        solver.most_iterations = std::min(solver.most_iterations, first_steps);
        std::vector<FittedCandidate> fits;
        for (const FactorCurves& start : starts)
            fits.push_back(fit_from(rank, bases, start, solver));
        std::sort(fits.begin(), fits.end(), [](const auto& a, const auto& b) {
            return a.fit.chi_squared < b.fit.chi_squared;
        });
        if (fits.front().fit.trace.converged)
            return std::move(fits.front());
        const FactorCurves reached = fits.front().model->curves(fits.front().fit.parameters);
        FittedCandidate best = fit_from(rank, bases, reached, settings_.solver);
        for (std::size_t k = 1; k < fits.size() && !best.fit.trace.converged; ++k)
            if (fits[k].fit.trace.converged)
                return std::move(fits[k]);
        return best;
    }

    CurveBases splines(double spacing_nm) const {
        return {spline_basis(target_.emission, spacing_nm),
                spline_basis(target_.excitation, spacing_nm)};
    }

    /// The fit with curves that are linear between as many bands as some bytes hold.
    FittedCandidate within(std::size_t bytes, FittedCandidate full) {
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
        return fit(rank,
                   {hat_basis(target_.emission, knots.emission),
                    hat_basis(target_.excitation, knots.excitation)},
                   {curves});
    }

    std::vector<FactorCurves> starts(int rank, const FactorCurves& smaller) const {
        return factor_starts(target_, rank, smaller, settings_.starts, settings_.seed);
    }

    FactorCurves no_curves() const {
        return {Eigen::MatrixXd(target_.value.rows(), 0), Eigen::MatrixXd(target_.value.cols(), 0)};
    }

private:
    FittedCandidate fit_from(int rank, const CurveBases& bases, const FactorCurves& start,
                             const SolverSettings& solver) {
        const auto& [emission, excitation] = bases;
        FittedCandidate candidate;
        candidate.penalty = std::make_unique<PhotonPenalty>(target_.value.cols());
        auto model = std::make_unique<FactorModel>(target_, rank, emission, excitation,
                                                   *candidate.penalty, settings_.loss, bend_width_);
        Eigen::VectorXd parameters =
            model->parameters(coefficients_near(emission, start.emission),
                              coefficients_near(excitation, start.excitation));
        model->balance(parameters);
        candidate.fit =
            minimise_within_budget(*model, target_, *candidate.penalty, parameters, solver, begin_);
        model->balance(candidate.fit.parameters);
        if (emission.is_per_band() && excitation.is_per_band()) {
            FactorCurves curves = model->curves(candidate.fit.parameters);
            bridge_hidden_bands(target_, curves);
            candidate.fit.parameters = model->parameters(curves.emission, curves.excitation);
        }
        candidate.model = std::move(model);
        candidate.spacing_nm = emission.spacing_nm;
        candidate.emission_knots = emission.knots;
        candidate.excitation_knots = excitation.knots;
        return candidate;
    }

    const FitTarget& target_;
    const FitSettings& settings_;
    Clock::time_point begin_;
    double bend_width_ = FactorModel::bend_of_lines;
};

/// Whether smooth curves lose no more than fewer numbers must. Schwarz's criterion would take
/// splines that bend less than the truth, whose bands then hold 80 % of it instead of 95.
class Smoothing {
public:
    Smoothing(const FittedCandidate& rough, Eigen::Index data, Evidence evidence)
        : chi_squared_(rough.fit.chi_squared), numbers_(needed_numbers(rough)) {
        const double freedom = std::max(1.0, static_cast<double>(data) - numbers_);
        variance_ = evidence == Evidence::KnownNoise ? 1.0 : chi_squared_ / freedom;
    }
    /// Chi squared may rise as one of that many degrees of freedom: by their number, give or take
    /// two standard deviations.
    bool may_be(const FittedCandidate& smooth) const {
        const double fewer = std::max(0.0, numbers_ - needed_numbers(smooth));
        return smooth.fit.chi_squared - chi_squared_ <=
               variance_ * (fewer + 2.0 * std::sqrt(2.0 * fewer));
    }

private:
    double chi_squared_, numbers_, variance_ = 1.0;
};

FactorCurves curves_of(const FittedCandidate& candidate) {
    return candidate.model->curves(candidate.fit.parameters);
}

/// Terms are added while the evidence for them is very strong: a Bayes factor of more than e^5
/// (Kass and Raftery 1995). The width of the prior of a term's bends is chosen by evidence, too.
FittedCandidate by_evidence(const FitTarget& target, FactorFitter& fitter, const CurveBases& bases,
                            Evidence evidence) {
    constexpr double very_strong = 10.0;
    constexpr double wider[] = {2.0 * FactorModel::bend_of_bands, FactorModel::bend_of_lines};
    const auto fitted = [&](int rank, double width, const std::vector<FactorCurves>& starts) {
        fitter.set_bend_width(width);
        FittedCandidate candidate = fitter.fit(rank, bases, starts);
        candidate.criterion = laplace_criterion(*candidate.model, candidate.fit, target, evidence);
        return candidate;
    };
    FittedCandidate best = dark_candidate(target, evidence);
    FactorCurves smaller = fitter.no_curves();
    double best_width = FactorModel::bend_of_bands;
    for (int rank = 1; rank <= largest_factor_rank; ++rank) {
        double width = FactorModel::bend_of_bands;
        FittedCandidate next = fitted(rank, width, fitter.starts(rank, smaller));
        for (const double other : wider) {
            FittedCandidate sharper = fitted(rank, other, {curves_of(next)});
            if (sharper.fit.trace.converged && sharper.criterion < next.criterion) {
                next = std::move(sharper);
                width = other;
            }
        }
        smaller = curves_of(next);
        if (next.criterion > best.criterion - very_strong)
            break;
        best = std::move(next);
        best_width = width;
    }
    fitter.set_bend_width(best_width);
    return best;
}

} // namespace

FittedCandidate fit_factors(const FitTarget& target, const FitSettings& settings, Evidence evidence,
                            Clock::time_point begin) {
    FactorFitter fitter(target, settings, begin);
    const CurveBases bases = fitter.splines(settings.smooth_nm.value_or(0.0));
    const std::size_t most_bytes =
        settings.most_bytes.value_or(std::numeric_limits<std::size_t>::max());
    if (settings.rank) {
        FactorCurves smaller = fitter.no_curves();
        for (int rank = 1; rank < *settings.rank; ++rank)
            smaller = fitter.starts(rank, smaller).front();
        return fitter.within(
            most_bytes, fitter.fit(*settings.rank, bases, fitter.starts(*settings.rank, smaller)));
    }
    FittedCandidate best = by_evidence(target, fitter, bases, evidence);
    if (!best.model || settings.smooth_nm || settings.most_bytes)
        return fitter.within(most_bytes, std::move(best));
    const FactorCurves start = curves_of(best);
    const Smoothing smoothing(best, target.used_count(), evidence);
    for (const double steps : spacings_in_steps) {
        FittedCandidate smooth = fitter.fit(
            best.model->terms(), fitter.splines(steps * target.emission.step_nm), {start});
        if (smooth.fit.trace.converged && smoothing.may_be(smooth))
            best = std::move(smooth);
    }
    return best;
}

} // namespace reradiant
