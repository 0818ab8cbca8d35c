#include "host/fit/fit_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

std::string first_fault(const FitResult& result) {
    if (!result.trace.converged)
        return fmt::format("the fit did not converge: {} (KKT violation {:.2g})",
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

void pass_diagonal(const PreparedTarget& prepared, FitResult& result) {
    const Eigen::VectorXd& diagonal = prepared.diagonal;
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
        if (measured)
            result.matrix.values(o, i) = diagonal(i);
        else
            result.matrix.values(o, i) =
                known.empty() ? 0.0
                              : Spectrum::table(nm, known)(result.matrix.excitation.centre_nm(i));
    }
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

void check_fit(FitResult& result) {
    result.anti_stokes_energy = anti_stokes_share(result.matrix);
    result.failure = first_fault(result);
}

} // namespace reradiant
