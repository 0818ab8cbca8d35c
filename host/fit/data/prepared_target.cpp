#include "host/fit/data/prepared_target.h"

#include "host/fit/data/noise_estimate.h"
#include "host/fit/data/rounding_steps.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
/// Files carry no more digits, and the rounding of a unit must not choose among solutions that fit
/// nearly alike.
Matrix single_precision(const Matrix& values) {
    return values.cast<float>().cast<double>();
}

Matrix entries_off_the_diagonal(const FitTarget& target, double spill_nm) {
    Matrix off(target.value.rows(), target.value.cols());
    for (int i = 0; i < target.excitation.count; ++i)
        for (int o = 0; o < target.emission.count; ++o)
            off(o, i) = std::abs(target.emission.centre_nm(o) - target.excitation.centre_nm(i)) >
                                spill_nm + 1e-6 * target.emission.step_nm
                            ? 1.0
                            : 0.0;
    return off;
}

/// Says which excitation bands hold nothing to fit, in one line.
void note_empty_columns(const PreparedTarget& prepared, const Matrix& value,
                        std::vector<std::string>& notes) {
    std::string list;
    int count = 0;
    for (int i = 0; i < prepared.target.excitation.count; ++i) {
        if (!value.col(i).array().isNaN().all())
            continue;
        list +=
            fmt::format("{}{}", count++ > 0 ? ", " : "", prepared.target.excitation.centre_nm(i));
    }
    if (count > 0)
        notes.push_back(fmt::format("nothing was measured at excitation {} nm: what the model says "
                                    "there is a guess",
                                    list));
}

void read_diagonal(const BispectralData& data, const Matrix& sigma, PreparedTarget& prepared) {
    const BispectralBlock& block = data.blocks.front();
    ReradiationMatrix grids;
    grids.emission = data.emission;
    grids.excitation = data.excitation;
    prepared.diagonal = Eigen::VectorXd::Constant(data.excitation.count, nan_value);
    prepared.diagonal_sigma = prepared.diagonal;
    int moved = 0;
    for (int i = 0; i < data.excitation.count; ++i) {
        const int o = diagonal_row(grids, i);
        if (o < 0 || !std::isfinite(block.value(o, i)))
            continue;
        prepared.diagonal(i) = std::clamp(block.value(o, i), 0.0, 1.0);
        prepared.diagonal_sigma(i) = sigma(o, i);
        moved += prepared.diagonal(i) != block.value(o, i) ? 1 : 0;
    }
    if (moved > 0)
        prepared.notes.push_back(
            fmt::format("{} diagonal entries below 0 or above 1 were moved to that limit", moved));
}

/// Reflected light is brighter than fluorescence and its noise may be larger, which an estimate
/// from the fluorescence does not see: where the diagonal clearly shows more, that is its error.
void take_noise_of_diagonal(PreparedTarget& prepared) {
    constexpr double clearly = 1.5; // an estimate from 20 differences is uncertain by a fifth
    const double noise = estimated_curve_noise(prepared.diagonal);
    for (double& sigma : prepared.diagonal_sigma)
        if (noise > clearly * sigma)
            sigma = noise;
}

/// Sets the photons that every column may emit: all, and those that the diagonal as measured has
/// not taken.
void set_photon_limits(PreparedTarget& prepared) {
    FitTarget& target = prepared.target;
    target.budget = Eigen::VectorXd::Constant(prepared.diagonal.size(), 1.0 / target.scale);
    target.spare = target.budget;
    target.spare_weight = Eigen::VectorXd::Zero(target.spare.size());
    for (Eigen::Index i = 0; i < target.spare.size(); ++i)
        if (std::isfinite(prepared.diagonal(i))) {
            target.spare(i) = (1.0 - prepared.diagonal(i)) / target.scale;
            target.spare_weight(i) = target.scale / prepared.diagonal_sigma(i);
        }
}

/// Returns true when entries lie so far below zero that noise cannot be the reason: 1 % of those
/// used beyond three standard errors, where normal noise leaves 0.13 %. Then an instrument's dark
/// signal is off, and no model that emits nothing negative can follow.
bool is_dark_signal_off(const Matrix& value, const Matrix& used, double noise) {
    constexpr double share = 0.01, fewest = 5.0, beyond = 3.0;
    const double below =
        ((used.array() > 0.0) && (value.array() < -beyond * noise)).cast<double>().sum();
    return below > std::max(fewest, share * used.sum());
}

/// Fills target.value and target.weight (in units of `scale`) from the used entries and their
/// errors.
void set_weights(const EntryErrors& errors, const Matrix& used, PreparedTarget& prepared) {
    FitTarget& target = prepared.target;
    prepared.noise_is_estimated = errors.is_estimated;
    prepared.noise = errors.noise;
    prepared.shared_rounding = errors.shared_rounding;
    prepared.notes.insert(prepared.notes.end(), errors.notes.begin(), errors.notes.end());
    const Matrix kept = (used.array() > 0.0).select(errors.value, target.value);
    const double peak = kept.cwiseAbs().maxCoeff();
    target.scale = peak > 0.0 ? peak : 1.0;
    target.value = single_precision(kept / target.scale);
    if (errors.is_estimated && is_dark_signal_off(kept, used, errors.noise)) {
        prepared.notes.push_back(
            fmt::format("{} negative entries are fitted as zero: many are far below the noise",
                        (target.value.array() < 0.0).count()));
        target.value = target.value.cwiseMax(0.0);
    }
    target.weight =
        single_precision((used.array() > 0.0).select(target.scale / errors.sigma.array(), 0.0));
}

} // namespace

Matrix saturated_entries(const Matrix& value) {
    constexpr int fewest = 4;
    Matrix plateau = Matrix::Zero(value.rows(), value.cols());
    double largest = 0.0;
    for (const double entry : value.reshaped())
        if (std::isfinite(entry))
            largest = std::max(largest, entry);
    if (largest > 0.0)
        plateau = (value.array() == largest).cast<double>();
    const double count = plateau.sum();
    // A matrix that is constant wherever it is not zero has no peak that could have been cut.
    const double bright = static_cast<double>((value.array() > 0.5 * largest).count());
    // Around a peak that is only rounded the next levels below hold as many entries.
    const double step = rounding_steps(value).maxCoeff();
    const double beside =
        static_cast<double>((value.array() > largest - 3.5 * step).count()) - count;
    if (count < fewest || count > 0.9 * bright || (step > 0.0 && count <= beside))
        plateau.setZero();
    return plateau;
}

PreparedTarget prepare_target(const BispectralData& data, const TargetSettings& settings) {
    const BispectralBlock& block = data.blocks.front();
    PreparedTarget prepared;
    FitTarget& target = prepared.target;
    target.emission = data.emission;
    target.excitation = data.excitation;
    target.photons = photon_weights(data.emission, data.excitation);
    target.allowed = allowed_entries(data.emission, data.excitation, settings.anti_stokes);
    target.value = Matrix::Zero(block.value.rows(), block.value.cols());
    target.weight = target.value;
    Matrix used = target.allowed.cwiseProduct(entries_off_the_diagonal(target, settings.spill_nm));
    used = used.array() * (block.value.array() == block.value.array()).cast<double>();
    const Matrix saturated = saturated_entries(
        (used.array() > 0.0).select(block.value, Matrix::Constant(used.rows(), used.cols(), 0.0)));
    if (saturated.sum() > 0.0)
        prepared.notes.push_back(fmt::format("{} saturated entries at the value {} were left out",
                                             saturated.sum(),
                                             saturated.cwiseProduct(block.value).maxCoeff()));
    used = used.cwiseProduct((1.0 - saturated.array()).matrix());
    const EntryErrors errors = entry_errors(block.value, block.sigma, used);
    set_weights(errors, used, prepared);
    read_diagonal(data, errors.sigma, prepared);
    note_empty_columns(prepared, block.value, prepared.notes);
    set_photon_limits(prepared);
    if (errors.is_estimated)
        take_noise_of_diagonal(prepared);
    return prepared;
}

} // namespace reradiant
