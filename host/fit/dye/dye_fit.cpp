#include "reradiant/dye_fit.h"

#include "host/fit/dye/dye_errors.h"
#include "host/fit/dye/dye_problem.h"
#include "host/fit/dye/dye_start.h"
#include "host/fit/dye/inner_filter.h"
#include "host/fit/models/model_selection.h"
#include "host/fit/solver/bounded_quadratic.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
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

/// A model at its minimum.
struct Candidate {
    std::unique_ptr<DyeModel> model;
    Vector packed, unseen; ///< unseen: standard errors of what is taken as dark, else 0
    SolveTrace trace;
    DyeEvidence evidence;
};

/// One fit: its data, and the steps from a first guess to the number of dyes.
class DyeFit {
public:
    DyeFit(const std::vector<BispectralData>& data, const DyeFitSettings& settings)
        : settings_(settings), begin_(Clock::now()),
          prepared_(prepare_dyes(data, settings, first_largest_depth)) {
        is_estimated_ = std::ranges::all_of(prepared_.sets, &DyeDataSet::noise_is_estimated);
    }

    const PreparedDyes& prepared() const { return prepared_; }
    bool noise_is_estimated() const { return is_estimated_; }
    double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

    /// The number of dyes that is asked for, or as many as lower the criterion.
    Candidate best(std::vector<DyeEvidence>& evidence) {
        Candidate best;
        const int first = settings_.dyes.value_or(1),
                  last = settings_.dyes.value_or(most_fitted_dyes);
        for (int dyes = first; dyes <= last; ++dyes) {
            Candidate next = fitted(dyes);
            evidence.push_back(next.evidence);
            const bool is_better =
                !best.model ||
                (next.trace.converged && next.evidence.criterion < best.evidence.criterion);
            if (!is_better)
                break;
            best = std::move(next);
        }
        return best;
    }

private:
    Candidate fitted(int dyes) {
        DyeProblem& problem = prepared_.problem;
        const WavelengthGrid& emission = prepared_.sets.front().data.emission;
        const double spacing = settings_.smooth_nm.value_or(0.0);
        Candidate candidate;
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

    void minimise(Candidate& candidate, int most_iterations) {
        SolverSettings solver = settings_.solver;
        solver.most_iterations = std::min(solver.most_iterations, most_iterations);
        candidate.trace.append(
            minimise_non_negative(*candidate.model, candidate.packed, solver, begin_));
    }
    void minimise(Candidate& candidate) { minimise(candidate, settings_.solver.most_iterations); }

    bool reaches_beyond_tables(const Candidate& candidate) const {
        constexpr double near = 0.8;
        const DyeProblem& problem = prepared_.problem;
        const Vector all = candidate.model->parameters(candidate.packed).absorption.rowwise().sum();
        return problem.samples.front().stack->largest_depth() < last_largest_depth &&
               all.maxCoeff() > near * problem.largest_absorption();
    }

    /// No dye sends out more photons than it takes.
    void hold_yields_at_one(Candidate& candidate) {
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
    void hold_what_is_unseen(Candidate& candidate, DyeSpectrum which) {
        constexpr double as_well = 4.0; // rise of chi squared a number
        const Vector sigma =
            dye_covariance(*candidate.model, candidate.packed, is_estimated_).sigma;
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

    /// Rounding of the tables may keep the cost from falling before the conditions of a minimum
    /// hold to all digits. It is one where no step would lower the cost by what noise does not
    /// notice.
    void judge_convergence(Candidate& candidate) const {
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

    void judge(Candidate& candidate) const {
        judge_convergence(candidate);
        const DyeModel& model = *candidate.model;
        const Index data = prepared_.problem.used_count();
        DyeEvidence& evidence = candidate.evidence;
        evidence.dyes = model.dyes();
        evidence.chi_squared = model.chi_squared(candidate.packed);
        // of an emission one number is its unit
        evidence.parameters =
            static_cast<int>((candidate.packed.array() > 0.0).count()) - model.dyes();
        evidence.criterion =
            information_criterion(evidence.chi_squared, evidence.parameters, data,
                                  is_estimated_ ? Evidence::EstimatedNoise : Evidence::KnownNoise);
        evidence.converged = candidate.trace.converged;
    }

    const DyeFitSettings& settings_;
    Clock::time_point begin_;
    PreparedDyes prepared_;
    bool is_estimated_ = false;
};

void take_dyes(const Candidate& candidate, const DyeErrors& errors, DyeFitResult& result) {
    const DyeProblem& problem = candidate.model->problem();
    const DyeParameters at = candidate.model->parameters(candidate.packed);
    const double step = problem.bands.step_nm, factor = problem.largest_factor();
    for (Index k = 0; k < candidate.model->dyes(); ++k) {
        const auto place = static_cast<std::size_t>(k);
        const BandedNumber& peak = errors.absorption_at_peak[place];
        result.dyes.push_back({at.absorption.col(k),
                               errors.absorption.col(k),
                               at.emission.col(k) / (at.emission.col(k).sum() * step),
                               errors.emission.col(k) / step,
                               errors.quantum_yield[place],
                               {factor * peak.value, factor * peak.low, factor * peak.high}});
    }
    if (problem.fits_scale)
        // what is fitted is the scale of what the first dye sends out
        result.scale =
            BandedNumber{errors.scale.value / std::max(at.quantum_yield(0), 1e-3),
                         errors.scale.low / std::max(errors.quantum_yield[0].high, 1e-3),
                         errors.scale.high / std::max(errors.quantum_yield[0].low, 1e-3)};
    if (problem.fits_substrate) {
        result.reflectance = at.reflectance;
        result.reflectance_sigma = errors.reflectance;
    }
}

/// What the dyes of the first set's layer absorb of light at right angles, and send out of it.
ReradiationMatrix own_matrix(const Candidate& candidate, const DyeDataSet& set) {
    const DyeProblem& problem = candidate.model->problem();
    const DyeParameters at = candidate.model->parameters(candidate.packed);
    const Matrix depth = problem.samples.front().depth_factor * at.absorption;
    Matrix all = Matrix::Zero(problem.bands.count, problem.bands.count);
    for (Index k = 0; k < depth.cols(); ++k) {
        const EmissionShares shares(at.emission.col(k), problem.bands);
        const Vector whole = depth.rowwise().sum();
        const Vector absorbed = (whole.array() > 0.0)
                                    .select(-(-whole.array()).expm1() * depth.col(k).array() /
                                                whole.array().max(1e-300),
                                            0.0);
        all += at.quantum_yield(k) * shares.matrix() * absorbed.asDiagonal();
    }
    ReradiationMatrix matrix;
    matrix.emission = set.data.emission;
    matrix.excitation = set.data.excitation;
    matrix.values = all.block(problem.emission.first, problem.excitation.first,
                              problem.emission.count, problem.excitation.count);
    return matrix;
}

void measure_errors(const Candidate& candidate, const PreparedDyes& prepared,
                    DyeFitResult& result) {
    double squares = 0.0, seen = 0.0, shifted_squares = 0.0, shifted_signal = 0.0;
    const auto images = candidate.model->images(candidate.packed);
    for (std::size_t s = 0; s < images.size(); ++s) {
        const DyeDataSet& set = prepared.sets[s];
        FittedDyeData fitted{set.data, images[s],     {},
                             set.mask, set.saturated, prepared.problem.samples[s].depth_factor};
        for (std::size_t b = 0; b < set.blocks.size(); ++b) {
            const DyeBlock& block = set.blocks[b];
            fitted.used.push_back((block.weight.array() > 0.0).cast<double>());
            for (int i = 0; i < set.data.excitation.count; ++i)
                for (int o = 0; o < set.data.emission.count; ++o) {
                    if (!(block.weight(o, i) > 0.0))
                        continue;
                    const double error = images[s][b](o, i) - block.value(o, i);
                    squares += error * error;
                    seen += 1.0;
                    if (set.data.emission.centre_nm(o) <=
                        set.data.excitation.centre_nm(i) + 1.001 * set.data.emission.step_nm)
                        continue;
                    const double signal = std::max(0.0, block.value(o, i));
                    shifted_squares += std::pow(images[s][b](o, i) - signal, 2);
                    shifted_signal += signal * signal;
                }
        }
        result.sets.push_back(std::move(fitted));
        result.notes.insert(result.notes.end(), set.notes.begin(), set.notes.end());
        result.noise = std::max(result.noise, set.noise);
    }
    result.rmse = std::sqrt(squares / std::max(1.0, seen));
    result.relative_rmse = shifted_signal > 0.0 ? std::sqrt(shifted_squares / shifted_signal) : 0.0;
}

/// The yield by the inner-filter correction, with the depth of all dyes that was fitted.
double yield_by_inner_filter(const Candidate& candidate, const PreparedDyes& prepared,
                             const DyeFitSettings& settings) {
    const DyeProblem& problem = prepared.problem;
    const Vector depth = problem.samples.front().depth_factor *
                         candidate.model->parameters(candidate.packed).absorption.rowwise().sum();
    const auto filter =
        inner_filter(settings.material.stack, prepared.sets.front().views.front(), depth, problem);
    if (!filter || problem.fits_scale)
        return std::numeric_limits<double>::quiet_NaN();
    return corrected_dye(*filter, prepared.sets.front().blocks.front(), problem).quantum_yield;
}

/// Says what the data do not tell, and why.
void note_what_is_open(const DyeFitResult& result, const DyeFitSettings& settings,
                       std::vector<std::string>& notes) {
    constexpr double wide = 0.5;
    if (result.sets.size() < 2 || (settings.thickness.empty() && settings.concentration.empty()))
        notes.push_back(
            "concentration and thickness are seen as one number, the optical depth: one "
            "amount of dye looks the same thin and strong or thick and weak");
    for (std::size_t k = 0; k < result.dyes.size(); ++k) {
        const BandedNumber& yield = result.dyes[k].quantum_yield;
        if (yield.high - yield.low > wide)
            notes.push_back(fmt::format(
                "the quantum yield of dye {} is hardly told by these data: {}", k + 1,
                settings.is_arbitrary_unit
                    ? "of an unknown unit only what is absorbed again and sent out again says it"
                    : "in thin layers over a dark ground only yield times depth is seen; give data "
                      "of several thicknesses or over a light ground"));
    }
}

void judge_residuals(const Candidate& candidate, double freedom, DyeFitResult& result) {
    result.reduced_chi_squared = candidate.evidence.chi_squared / freedom;
    if (!candidate.trace.converged)
        result.failure = "the fit did not converge: " + candidate.trace.stop_reason;
    if (!residuals_are_noise(candidate.evidence.chi_squared, result.data_count, freedom))
        result.shortfall = fmt::format("residuals are {:.3g} times the noise: there is more in the "
                                       "data than {} dye{} in this stack",
                                       std::sqrt(result.reduced_chi_squared), result.dyes.size(),
                                       result.dyes.size() == 1 ? "" : "s");
}

} // namespace

DyeFitResult fit_dyes(const std::vector<BispectralData>& data, const DyeFitSettings& settings) {
    DyeFit fit(data, settings);
    DyeFitResult result;
    const Candidate candidate = fit.best(result.evidence);
    const PreparedDyes& prepared = fit.prepared();
    for (Index dye = 0; dye < candidate.model->dyes(); ++dye) // what is held at 1 is uncertain, too
        candidate.model->release(candidate.model->places().quantum_yield + dye);
    const DyeCovariance covariance =
        dye_covariance(*candidate.model, candidate.packed, fit.noise_is_estimated());
    const DyeErrors errors = dye_errors(*candidate.model, candidate.packed, covariance,
                                        candidate.unseen, settings.solver);
    result.bands = prepared.problem.bands;
    result.spacing_nm = candidate.model->absorption_basis().spacing_nm;
    result.noise_is_estimated = fit.noise_is_estimated();
    result.trace = candidate.trace;
    result.data_count = static_cast<int>(prepared.problem.used_count());
    result.parameters = covariance.covariance.free - candidate.model->dyes();
    result.covariance_rank = std::min(covariance.covariance.rank, result.parameters);
    take_dyes(candidate, errors, result);
    result.matrix = own_matrix(candidate, prepared.sets.front());
    measure_errors(candidate, prepared, result);
    result.inner_filter_yield = yield_by_inner_filter(candidate, prepared, settings);
    judge_residuals(candidate, std::max(1, result.data_count - candidate.evidence.parameters),
                    result);
    note_what_is_open(result, settings, result.notes);
    result.seconds = fit.seconds();
    return result;
}

} // namespace reradiant
