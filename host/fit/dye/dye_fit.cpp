#include "host/fit/dye/dye_fit.h"

#include "host/fit/dye/dye_search.h"
#include "host/fit/dye/result/dye_errors.h"
#include "host/fit/dye/result/inner_filter.h"
#include "host/fit/models/model_selection.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

void take_dyes(const DyeCandidate& candidate, const DyeErrors& errors, DyeFitResult& result) {
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
ReradiationMatrix own_matrix(const DyeCandidate& candidate, const DyeDataSet& set) {
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

void measure_errors(const DyeCandidate& candidate, const PreparedDyes& prepared,
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
double yield_by_inner_filter(const DyeCandidate& candidate, const PreparedDyes& prepared,
                             const DyeFitSettings& settings) {
    const DyeProblem& problem = prepared.problem;
    const Vector depth = problem.samples.front().depth_factor *
                         candidate.model->parameters(candidate.packed).absorption.rowwise().sum();
    const auto filter =
        inner_filter(settings.material.stack, prepared.sets.front().views.front(), depth, problem);
    const Substrate& ground = settings.material.substrate;
    constexpr double dark = 0.05;
    const bool has_dark_ground =
        settings.material.stack.is_sheet() ||
        (!settings.fits_substrate && !ground.is_fluorescent() &&
         ground.reflectance.maximum(problem.bands.lower_edge_nm(0), problem.bands.to_nm()) <= dark);
    if (!filter || problem.fits_scale || !has_dark_ground)
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

void judge_residuals(const DyeCandidate& candidate, double freedom, DyeFitResult& result) {
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
    DyeSearch fit(data, settings);
    DyeFitResult result;
    const DyeCandidate candidate = fit.best(result.evidence);
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
