#include "host/fit/prepared_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
/// Data without noise are weighed as if they had this share of their peak: single precision files
/// carry no more.
constexpr double smallest_noise = 1e-6;

double median(std::vector<double> values) {
    if (values.empty())
        return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

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
        const auto column = value.col(i).array();
        if ((column == column).any())
            continue;
        list +=
            fmt::format("{}{}", count++ > 0 ? ", " : "", prepared.target.excitation.centre_nm(i));
    }
    if (count > 0)
        notes.push_back(fmt::format("nothing was measured at excitation {} nm: what the model says "
                                    "there is a guess",
                                    list));
}

void read_diagonal(const BispectralData& data, PreparedTarget& prepared) {
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
        prepared.diagonal_sigma(i) =
            std::isfinite(block.sigma(o, i)) ? block.sigma(o, i) : prepared.noise;
        moved += prepared.diagonal(i) != block.value(o, i) ? 1 : 0;
    }
    if (moved > 0)
        prepared.notes.push_back(
            fmt::format("{} diagonal entries below 0 or above 1 were moved to that limit", moved));
}

/// What every column may still emit: photons that the diagonal has not taken.
Eigen::VectorXd photon_budget(const PreparedTarget& prepared) {
    Eigen::VectorXd budget(prepared.diagonal.size());
    for (Eigen::Index i = 0; i < budget.size(); ++i)
        budget(i) = 1.0 - (std::isfinite(prepared.diagonal(i)) ? prepared.diagonal(i) : 0.0);
    return budget / prepared.target.scale;
}

/// Noise seen through mixed differences with these weights in both directions; 0 when fewer than 16
/// places can be looked at.
double noise_of_differences(const Matrix& value, const Matrix& used,
                            const Eigen::VectorXd& weights) {
    constexpr std::size_t fewest = 16;
    const Eigen::Index n = weights.size();
    std::vector<double> sizes;
    for (Eigen::Index i = 0; i + n <= value.cols(); ++i)
        for (Eigen::Index o = 0; o + n <= value.rows(); ++o)
            if (used.block(o, i, n, n).minCoeff() > 0.0)
                sizes.push_back(std::abs(weights.dot(value.block(o, i, n, n) * weights)));
    if (sizes.size() < fewest)
        return 0.0;
    // 1.4826 times the median of |x| is the standard deviation of normal noise (Hampel 1974).
    return 1.4826 * median(sizes) / weights.squaredNorm();
}

/// Whether entries lie so far below zero that noise cannot be the reason: 1 % of those used beyond
/// three standard errors, where normal noise leaves 0.13 %. Then an instrument's dark signal is
/// off, and no model that emits nothing negative can follow.
bool is_dark_signal_off(const Matrix& value, const Matrix& used, double noise) {
    constexpr double share = 0.01, fewest = 5.0, beyond = 3.0;
    const double below =
        ((used.array() > 0.0) && (value.array() < -beyond * noise)).cast<double>().sum();
    return below > std::max(fewest, share * used.sum());
}

/// Fills target.weight (in units of 1 / scale) from standard errors, given or estimated.
void set_weights(const BispectralBlock& block, const Matrix& used, PreparedTarget& prepared) {
    FitTarget& target = prepared.target;
    const double floor = smallest_noise * target.scale;
    std::vector<double> known;
    for (Eigen::Index k = 0; k < used.size(); ++k)
        if (used(k) > 0.0 && std::isfinite(block.sigma(k)))
            known.push_back(block.sigma(k));
    prepared.noise_is_estimated = known.empty();
    prepared.noise = known.empty() ? estimated_noise(block.value, used) : median(known);
    if (prepared.noise < floor) {
        prepared.noise = floor;
        prepared.notes.push_back(
            fmt::format("no noise is seen in the data; weighed as if it were {:.1g}", floor));
    }
    if (prepared.noise_is_estimated && is_dark_signal_off(block.value, used, prepared.noise)) {
        prepared.notes.push_back(
            fmt::format("{} negative entries are fitted as zero: many are far below the noise",
                        (target.value.array() < 0.0).count()));
        target.value = target.value.cwiseMax(0.0);
    }
    for (Eigen::Index k = 0; k < used.size(); ++k) {
        const double sigma =
            std::isfinite(block.sigma(k)) ? std::max(block.sigma(k), floor) : prepared.noise;
        target.weight(k) = used(k) > 0.0 ? target.scale / sigma : 0.0;
    }
    target.weight = single_precision(target.weight);
}

} // namespace

double estimated_noise(const Matrix& value, const Matrix& used) {
    Eigen::VectorXd second(3), fourth(5);
    second << 1.0, -2.0, 1.0;
    fourth << 1.0, -4.0, 6.0, -4.0, 1.0;
    const double coarse = noise_of_differences(value, used, second);
    const double fine = noise_of_differences(value, used, fourth);
    return fine > 0.0 ? std::min(coarse, fine) : coarse;
}

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
    if (count < fewest || count > 0.9 * bright)
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
    const Matrix kept = (used.array() > 0.0).select(block.value, target.value);
    const double peak = kept.cwiseAbs().maxCoeff();
    target.scale = peak > 0.0 ? peak : 1.0;
    target.value = single_precision(kept / target.scale);
    set_weights(block, used, prepared);
    read_diagonal(data, prepared);
    note_empty_columns(prepared, block.value, prepared.notes);
    target.budget = photon_budget(prepared);
    return prepared;
}

} // namespace reradiant
