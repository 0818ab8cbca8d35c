#include "host/study/converge/error_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

/// The chance of an error beyond the estimate's upper end at this normal quantile is 5e-4.
constexpr double far_quantile = 3.29;
constexpr double interval_quantile = 1.96; ///< of RelmseEstimate::high

template <typename Value>
std::vector<double> column(const ErrorCurve& curve, const Value& value) {
    std::vector<double> values;
    for (const CurveRow& row : curve.rows)
        values.push_back(value(row));
    return values;
}

std::vector<double> seconds_of(const ErrorCurve& curve) {
    return column(curve, [](const CurveRow& row) { return row.seconds; });
}

/// Returns the largest error that the estimate allows, its value where it has no upper end, and 0
/// where there is no estimate.
double upper_end(const RelmseEstimate& estimate) {
    if (!std::isfinite(estimate.high) || !(estimate.value > 0.0))
        return std::isfinite(estimate.value) ? estimate.value : 0.0;
    return estimate.value *
           std::pow(estimate.high / estimate.value, far_quantile / interval_quantile);
}

} // namespace

double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y) {
    double n = 0.0, mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        if (!(x[k] > 0.0) || !(y[k] > 0.0) || !std::isfinite(y[k]))
            continue;
        const double lx = std::log(x[k]), ly = std::log(y[k]);
        n += 1.0;
        const double dx = lx - mean_x;
        mean_x += dx / n;
        mean_y += (ly - mean_y) / n;
        xx += dx * (lx - mean_x);
        xy += dx * (ly - mean_y);
    }
    return xx > 0.0 ? xy / xx : std::numeric_limits<double>::quiet_NaN();
}

double slope_over_samples(const ErrorCurve& curve) {
    return fitted_exponent(
        column(curve, [](const CurveRow& row) { return static_cast<double>(row.samples); }),
        column(curve, [](const CurveRow& row) { return row.error.rmse; }));
}

double slope_over_seconds(const ErrorCurve& curve) {
    return fitted_exponent(seconds_of(curve),
                           column(curve, [](const CurveRow& row) { return row.error.relmse; }));
}

double efficiency(const ErrorCurve& curve) {
    if (curve.rows.empty())
        return std::numeric_limits<double>::quiet_NaN();
    const CurveRow& last = curve.rows.back();
    return 1.0 / (last.error.relmse * last.seconds);
}

std::optional<double> seconds_to_reach(const ErrorCurve& curve, double target) {
    const CurveRow* before = nullptr;
    for (const CurveRow& row : curve.rows) {
        if (row.error.relmse <= target) {
            if (before == nullptr || !(row.error.relmse > 0.0))
                return row.seconds;
            const double share = std::log(before->error.relmse / target) /
                                 std::log(before->error.relmse / row.error.relmse);
            return before->seconds * std::pow(row.seconds / before->seconds, share);
        }
        before = &row;
    }
    return std::nullopt;
}

BiasFloor bias_floor(const ErrorCurve& curve, const RelmseEstimate& reference) {
    BiasFloor floor;
    if (curve.rows.empty() || !std::isfinite(curve.rows.back().estimate.value))
        return floor;
    const CurveRow& last = curve.rows.back();
    const double noise = last.estimate.value;
    const double reference_noise = std::isfinite(reference.value) ? reference.value : 0.0;
    const double most = upper_end(last.estimate) + upper_end(reference);
    floor.smallest_visible = most - noise - reference_noise;
    if (!(last.error.relmse > most))
        return floor;
    floor.relmse = last.error.relmse - noise - reference_noise;
    // Noise falls as 1/t; where it is not yet below the bias the method still improves.
    if (noise < floor.relmse)
        floor.seconds = last.seconds * noise / floor.relmse;
    return floor;
}

} // namespace reradiant
