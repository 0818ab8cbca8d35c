#include "reradiant/fit.h"

#include "host/fit/data/fit_mask.h"
#include "host/fit/data/prepared_target.h"
#include "host/fit/factors/factor_fit.h"
#include "host/fit/models/gaussian_fit.h"
#include "host/fit/models/matrix_fit.h"
#include "host/fit/result/error_bands.h"
#include "host/fit/result/fit_checks.h"
#include "host/fit/result/fit_covariance.h"
#include "host/fit/stack/stack_inversion.h"
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
using Clock = std::chrono::steady_clock;

void check_model(const FitSettings& settings) {
    const int most =
        settings.model == FitModel::Factors ? largest_factor_rank : largest_gaussian_count;
    if (settings.rank && settings.model == FitModel::Matrix)
        throw_input_error({}, "--rank does not go with the model matrix",
                          "leave it out or choose factors or gaussians");
    if (settings.most_bytes && settings.model != FitModel::Factors)
        throw_input_error(
            {},
            fmt::format("--bytes does not go with the model {}", fit_model_name(settings.model)),
            "leave it out or choose factors");
    if (settings.covariance && settings.model == FitModel::Matrix)
        throw_input_error({}, "--covariance does not go with the model matrix",
                          "choose factors or gaussians");
    if (settings.rank && (*settings.rank < 1 || *settings.rank > most))
        throw_input_error(
            {}, fmt::format("--rank {} is out of range", *settings.rank),
            fmt::format("{} takes 1 to {} terms", fit_model_name(settings.model), most));
}

/// Numbers that are not zero and that used entries depend on, but for those chosen at will.
Eigen::Index numbers_to_determine(const FittedCandidate& candidate, const FitTarget& target) {
    const TermModel& model = *candidate.model;
    const Eigen::VectorXd seen =
        (target.weight.reshaped().array() > 0.0).cast<double>().matrix().transpose() *
        model.entry_jacobian(candidate.fit.parameters).cwiseAbs();
    return ((candidate.fit.parameters.array() != 0.0) && (seen.array() > 0.0)).count() -
           model.terms() * model.free_units();
}

void refuse_too_few_data(const BispectralData& data, Eigen::Index used, Eigen::Index needed) {
    if (used < needed)
        throw_input_error(
            {data.file.string()},
            fmt::format("{} usable entries cannot determine {} numbers", used, needed),
            "measure more bands, or lower --rank or raise --smooth-nm");
}

void set_error_bands(const FittedCandidate& candidate, const PreparedTarget& prepared,
                     const FitSettings& settings, FitResult& result) {
    const TermModel& model = *candidate.model;
    const Vector& parameters = candidate.fit.parameters;
    const Matrix jacobian = model.entry_jacobian(parameters);
    const Covariance covariance =
        covariance_at(model, candidate.fit, prepared.target, *candidate.penalty, settings.loss,
                      prepared.noise_is_estimated, prepared.errors ? &*prepared.errors : nullptr,
                      settings.covariance);
    result.sigma = prepared.target.scale *
                   covariance.sigma(jacobian).reshaped(result.sigma.rows(), result.sigma.cols());
    if (settings.covariance)
        result.covariance =
            covariance_of_model(model, parameters, jacobian, covariance, prepared.target);
    // Errors are unknown where a whole column is missing: the model only bridges its neighbours.
    for (Eigen::Index i = 0; i < result.data.cols(); ++i)
        if ((result.data.col(i).array() != result.data.col(i).array()).all())
            result.sigma.col(i).setConstant(std::numeric_limits<double>::quiet_NaN());
    NormalisedCurves curves = normalised_curves(model, parameters, covariance, prepared.target);
    result.emission = std::move(curves.emission);
    result.excitation = std::move(curves.excitation);
    result.quantum_yield = quantum_yields(
        emitted_photons(model, parameters, jacobian, covariance, prepared.target),
        balanced_diagonal(prepared, result.matrix), prepared.diagonal_sigma, result.warnings);
    judge_residuals(prepared, settings, candidate.fit.chi_squared,
                    static_cast<double>(prepared.target.used_count()) - covariance.effective,
                    result);
    result.parameters = covariance.free - model.terms() * model.free_units();
    result.covariance_rank = std::min(covariance.rank, result.parameters);
    if (result.covariance_rank < result.parameters)
        result.warnings.push_back(fmt::format(
            "the data leave {} combinations of the model's numbers undetermined: the matrix is "
            "known, but how its terms share it is not",
            result.parameters - result.covariance_rank));
}

std::vector<double> centres_of(const std::vector<int>& bands, const WavelengthGrid& grid) {
    std::vector<double> nm;
    for (const int band : bands)
        nm.push_back(grid.centre_nm(band));
    return nm;
}

void take_terms(const BispectralData& data, const FittedCandidate& candidate,
                const PreparedTarget& prepared, const FitSettings& settings, FitResult& result) {
    result.trace = candidate.fit.trace;
    const auto used = prepared.target.used_count();
    if (!candidate.model) {
        judge_residuals(prepared, settings, candidate.fit.chi_squared, static_cast<double>(used),
                        result);
        result.notes.push_back("no fluorescence is seen in the data beyond their noise");
        return;
    }
    refuse_too_few_data(data, used, numbers_to_determine(candidate, prepared.target));
    result.rank = candidate.model->terms();
    result.spacing_nm = candidate.spacing_nm;
    result.emission_knots_nm = centres_of(candidate.emission_knots, data.emission);
    result.excitation_knots_nm = centres_of(candidate.excitation_knots, data.excitation);
    result.bytes = 4 * candidate.model->stored_numbers();
    result.matrix.values =
        prepared.target.scale * candidate.model->matrix(candidate.fit.parameters);
    set_error_bands(candidate, prepared, settings, result);
}

/// Adds to the standard errors what entries share, as far as it exceeds their own error: it does
/// not average out over them.
void add_shared_errors(const PreparedTarget& prepared, Matrix& sigma) {
    const FitTarget& target = prepared.target;
    const Matrix all = prepared.errors->entry_variance();
    for (Eigen::Index k = 0; k < sigma.size(); ++k)
        if (target.weight(k) > 0.0)
            sigma(k) =
                std::sqrt(sigma(k) * sigma(k) +
                          std::max(0.0, all(k) - std::pow(target.scale / target.weight(k), 2)));
}

void take_matrix(const MatrixFit& fit, const PreparedTarget& prepared, const FitSettings& settings,
                 FitResult& result) {
    result.trace = fit.fit.trace;
    result.bytes = 4 * fit.stored_numbers;
    result.matrix.values = prepared.target.scale * fit.value;
    result.sigma = prepared.target.scale * fit.sigma;
    if (prepared.errors)
        add_shared_errors(prepared, result.sigma);
    judge_residuals(prepared, settings, fit.fit.chi_squared,
                    static_cast<double>(prepared.target.used_count()) - fit.effective_numbers,
                    result);
    result.parameters = static_cast<int>(fit.stored_numbers);
    result.covariance_rank = static_cast<int>(std::lround(fit.effective_numbers));
    result.quantum_yield = quantum_yields(fit.emitted, balanced_diagonal(prepared, result.matrix),
                                          prepared.diagonal_sigma, result.warnings);
}

void take_model(const BispectralData& data, const PreparedTarget& prepared,
                const FitSettings& settings, Clock::time_point begin, FitResult& result) {
    const Evidence evidence =
        prepared.noise_is_estimated ? Evidence::EstimatedNoise : Evidence::KnownNoise;
    const FitTarget& target = prepared.target;
    if (target.value.isZero(0.0))
        take_terms(data, dark_candidate(target, evidence), prepared, settings, result);
    else if (settings.model == FitModel::Matrix)
        take_matrix(fit_matrix(target, settings, prepared.noise_is_estimated, begin), prepared,
                    settings, result);
    else
        take_terms(data,
                   settings.model == FitModel::Factors
                       ? fit_factors(target, settings, evidence, begin)
                       : fit_gaussians(target, settings, evidence, begin),
                   prepared, settings, result);
}

FitResult empty_result(const BispectralData& data, const PreparedTarget& prepared,
                       const FitSettings& settings) {
    FitResult result;
    result.model = settings.model;
    result.matrix.emission = data.emission;
    result.matrix.excitation = data.excitation;
    result.matrix.values = Matrix::Zero(data.emission.count, data.excitation.count);
    result.matrix.anti_stokes_allowed = settings.anti_stokes;
    result.matrix.geometry = data.geometry;
    result.sigma = result.matrix.values;
    result.data = data.blocks.front().value;
    result.used = (prepared.target.weight.array() > 0.0).cast<double>();
    result.noise = prepared.noise;
    result.noise_is_estimated = prepared.noise_is_estimated;
    result.notes = prepared.notes;
    return result;
}

double spill_nm(const BispectralData& data, const FitSettings& settings) {
    return settings.spill_nm.value_or(data.emission.step_nm);
}

FitResult fit_bare(const SubstrateData& substrate, const FitSettings& settings,
                   Clock::time_point begin) {
    const BispectralData& data = substrate.data;
    PreparedTarget prepared =
        prepare_target(data, {settings.anti_stokes, spill_nm(data, settings)});
    prepared.noise_is_estimated = prepared.noise_is_estimated || substrate.noise_is_estimated;
    prepared.errors = substrate.errors;
    FitResult result = empty_result(data, prepared, settings);
    take_model(data, prepared, settings, begin, result);
    add_rounding(prepared, result);
    pass_diagonal(prepared, result);
    if (settings.covariance)
        finish_covariance(prepared, result);
    measure_errors(prepared, result);
    return result;
}

} // namespace

FitModel fit_model_from_name(const std::string& name) {
    for (const FitModel model : {FitModel::Factors, FitModel::Gaussians, FitModel::Matrix})
        if (name == fit_model_name(model))
            return model;
    throw_input_error({}, fmt::format("--model {} is not known", name),
                      "write factors, gaussians or matrix");
}

const char* fit_model_name(FitModel model) {
    switch (model) {
    case FitModel::Gaussians:
        return "gaussians";
    case FitModel::Matrix:
        return "matrix";
    case FitModel::Factors:
        break;
    }
    return "factors";
}

FitResult fit_reradiation(const BispectralData& data, const FitSettings& settings) {
    const Clock::time_point begin = Clock::now();
    check_model(settings);
    FitMask mask = mask_of(data, settings.mask, {spill_nm(data, settings), settings.anti_stokes});
    const SubstrateData substrate =
        invert_stack(with_gaps(data, mask), settings.stack.value_or(LayerStack{}), settings.unknown,
                     settings.anti_stokes);
    FitResult result = fit_bare(substrate, settings, begin);
    result.notes.insert(result.notes.begin(), substrate.notes.begin(), substrate.notes.end());
    result.notes.insert(result.notes.begin(), mask.notes.begin(), mask.notes.end());
    result.warnings.insert(result.warnings.begin(), mask.warnings.begin(), mask.warnings.end());
    result.mask = std::move(mask);
    if (settings.unknown.any())
        result.stack = substrate.estimate;
    check_fit(result);
    result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return result;
}

} // namespace reradiant
