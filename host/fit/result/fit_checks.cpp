#include "host/fit/result/fit_checks.h"

#include "host/fit/models/model_selection.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

constexpr double balance_limit = 1.0 + 1e-6;

/// Sum of the entries below their excitation over the sum of all off the diagonal.
double anti_stokes_share(const ReradiationMatrix& matrix) {
    double below = 0.0, all = 0.0;
    const Eigen::MatrixXd fluorescent = matrix.fluorescent_part();
    for (int i = 0; i < matrix.excitation.count; ++i)
        for (int o = 0; o < matrix.emission.count; ++o) {
            all += std::abs(fluorescent(o, i));
            if (matrix.emission.centre_nm(o) < matrix.excitation.centre_nm(i))
                below += std::abs(fluorescent(o, i));
        }
    return all > 0.0 ? below / all : 0.0;
}

/// An estimate of the noise by the median of differences, which share their data, is worth so much
/// fewer data than there are: that of 250 entries has a standard error of 12 %.
constexpr double data_of_an_estimate = 6.0;
constexpr double certain_noise = std::numeric_limits<double>::infinity();

/// Returns the factor by which the square of a noise may be underestimated when it comes from so
/// many data: three standard errors.
double largest_factor_of(double data) {
    return 1.0 + 3.0 * std::sqrt(2.0 / data);
}

/// Returns what every column leaves to its diagonal, which is still zero, within the balances of
/// energy and of photons.
Eigen::VectorXd room_for_diagonal(const ReradiationMatrix& matrix) {
    const ColumnBalance balance = column_balance(matrix);
    Eigen::VectorXd room(matrix.excitation.count);
    for (Eigen::Index i = 0; i < room.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        room(i) = std::max(0.0, 1.0 - std::max(balance.radiant[k], balance.photons[k]));
    }
    return room;
}

/// Says how far the diagonal gave way to what is emitted.
void note_lowered(const PreparedTarget& prepared, const Eigen::VectorXd& room, FitResult& result) {
    const Eigen::ArrayXd lowered = (prepared.diagonal - room).array();
    const Eigen::Index count = (lowered > 0.0).count();
    if (count == 0)
        return;
    const double errors =
        (lowered > 0.0).select(lowered / prepared.diagonal_sigma.array(), 0.0).maxCoeff();
    result.notes.push_back(fmt::format(
        "{} diagonal entries were lowered, by up to {:.2g} ({:.1f} standard errors), so that no "
        "more photons leave than arrive",
        count, (lowered > 0.0).select(lowered, 0.0).maxCoeff(), errors));
}

std::string first_fault(const FitResult& result) {
    if (!result.trace.converged)
        return fmt::format(
            "the fit did not converge: {} (the conditions of a minimum are missed by {:.2g})",
            result.trace.stop_reason, result.trace.kkt);
    if (!result.matrix.values.allFinite())
        return "the fitted matrix holds values that are not finite";
    if (result.matrix.values.minCoeff() < 0.0)
        return "the fitted matrix holds negative values";
    if (!result.matrix.anti_stokes_allowed && result.anti_stokes_energy > 0.0)
        return "the fitted matrix holds anti-Stokes energy";
    const ColumnBalance balance = column_balance(result.matrix);
    for (int i = 0; i < result.matrix.excitation.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (balance.radiant[k] > balance_limit || balance.photons[k] > balance_limit)
            return fmt::format("excitation {} nm would emit {:.6f} of its energy and {:.6f} of its "
                               "photons",
                               result.matrix.excitation.centre_nm(i), balance.radiant[k],
                               balance.photons[k]);
    }
    return {};
}

} // namespace

Eigen::VectorXd balanced_diagonal(const PreparedTarget& prepared, const ReradiationMatrix& matrix) {
    const Eigen::ArrayXd measured = prepared.diagonal.array();
    const Eigen::ArrayXd room = room_for_diagonal(matrix).array();
    return (room < measured).select(room, measured); // NaN stays
}

void pass_diagonal(const PreparedTarget& prepared, FitResult& result) {
    const Eigen::VectorXd& diagonal = prepared.diagonal;
    const Eigen::VectorXd room = room_for_diagonal(result.matrix);
    std::vector<double> nm, known;
    for (Eigen::Index i = 0; i < diagonal.size(); ++i)
        if (std::isfinite(diagonal(i))) {
            nm.push_back(result.matrix.excitation.centre_nm(static_cast<int>(i)));
            known.push_back(diagonal(i));
        }
    int bridged = 0;
    for (int i = 0; i < result.matrix.excitation.count; ++i) {
        const int o = diagonal_row(result.matrix, i);
        if (o < 0)
            continue;
        const bool measured = std::isfinite(diagonal(i));
        bridged += measured ? 0 : 1;
        result.sigma(o, i) = prepared.diagonal_sigma(i);
        const double value =
            measured        ? diagonal(i)
            : known.empty() ? 0.0
                            : Spectrum::table(nm, known)(result.matrix.excitation.centre_nm(i));
        result.matrix.values(o, i) = std::min(value, room(i));
    }
    note_lowered(prepared, room, result);
    if (bridged > 0)
        result.notes.push_back(
            known.empty()
                ? "no diagonal was measured; it is zero in the result"
                : fmt::format("{} diagonal entries were not measured and are interpolated",
                              bridged));
}

void measure_errors(const PreparedTarget& prepared, FitResult& result) {
    const WavelengthGrid &emission = result.matrix.emission, &excitation = result.matrix.excitation;
    double squares = 0.0, beyond = 0.0, whole = 0.0;
    for (int i = 0; i < excitation.count; ++i)
        for (int o = 0; o < emission.count; ++o) {
            const double value = result.data(o, i), model = result.matrix.values(o, i);
            if (prepared.target.weight(o, i) > 0.0)
                squares += (model - value) * (model - value);
            const bool counts =
                emission.centre_nm(o) > excitation.centre_nm(i) + emission.step_nm * (1.0 + 1e-6);
            if (!counts || !std::isfinite(value))
                continue;
            beyond += std::pow(model - std::max(value, 0.0), 2);
            whole += std::pow(std::max(value, 0.0), 2);
        }
    const auto used = static_cast<double>(std::max<Eigen::Index>(1, prepared.target.used_count()));
    result.rmse = std::sqrt(squares / used);
    result.relative_rmse = whole > 0.0 ? std::sqrt(beyond / whole) : 0.0;
}

void add_rounding(const PreparedTarget& prepared, FitResult& result) {
    result.sigma =
        (prepared.target.allowed.array() > 0.0)
            .select(
                (result.sigma.array().square() + prepared.shared_rounding.array().square()).sqrt(),
                result.sigma.array());
}

void judge_residuals(const PreparedTarget& prepared, const FitSettings& settings,
                     double chi_squared, double freedom, FitResult& result) {
    const double used = static_cast<double>(prepared.target.used_count());
    freedom = std::max(1.0, freedom);
    result.reduced_chi_squared = chi_squared / freedom;
    const double estimate =
        prepared.noise_is_estimated ? used / data_of_an_estimate : certain_noise;
    if (residuals_are_noise(chi_squared / largest_factor_of(estimate), used, freedom)) {
        const double factor =
            std::isfinite(estimate) ? (estimate + chi_squared) / (estimate + freedom) : 1.0;
        if (factor > 1.0) {
            result.noise *= std::sqrt(factor);
            result.reduced_chi_squared /= factor;
        }
        return;
    }
    if (settings.loss != RobustLoss::None)
        return;
    const bool is_matrix = settings.model == FitModel::Matrix;
    result.shortfall = fmt::format(
        "the residuals are {:.2g} times the noise (reduced chi squared {:.4g}), so that the data "
        "hold more than {}{}",
        std::sqrt(result.reduced_chi_squared), result.reduced_chi_squared,
        is_matrix ? "a smooth matrix"
                  : fmt::format("{} {} of {}", result.rank, result.rank == 1 ? "term" : "terms",
                                fit_model_name(settings.model)),
        is_matrix ? "" : "; --model matrix follows them entry by entry");
}

void check_fit(FitResult& result) {
    result.anti_stokes_energy = anti_stokes_share(result.matrix);
    result.failure = first_fault(result);
}

} // namespace reradiant
