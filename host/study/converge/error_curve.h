#pragma once

#include "host/render/film/error_estimate.h"
#include "host/study/converge/render_method.h"
#include "reradiant/spectral_image.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace reradiant {

/// The error of one method after some time of rendering.
struct CurveRow {
    double seconds = 0.0;            ///< rendering alone: no set-up, no comparing, no writing
    double seconds_with_setup = 0.0; ///< reading tables and building kernels too
    std::uint32_t samples = 0;
    Comparison error;
    RelmseEstimate estimate; ///< what the render says about its own noise
};

struct ErrorCurve {
    RenderMethod method;
    double setup_seconds = 0.0; ///< tables and kernels, until light is traced
    double build_seconds = 0.0; ///< part of them: compiling or loading kernels
    std::vector<CurveRow> rows; ///< at geometric steps of time, ascending
};

/// Exponent p of y ~ x^p by least squares of the logarithms; NaN below two usable points.
double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y);

/// RMSE over samples: -0.5 for independent samples without bias.
double slope_over_samples(const ErrorCurve& curve);
/// relMSE over seconds: -1 for the same.
double slope_over_seconds(const ErrorCurve& curve);

/// 1 / (relMSE x seconds) at the curve's end: constant along the curve of an unbiased method.
double efficiency(const ErrorCurve& curve);

/// Seconds until relMSE is at most `target`, between rows on a straight line of the logarithms;
/// nothing when it is not reached.
std::optional<double> seconds_to_reach(const ErrorCurve& curve, double target);

/// A `BiasFloor` says where a method stops improving. Its error is that of its noise, which the
/// render estimates, and of the reference's noise; what is left over is bias.
struct BiasFloor {
    double relmse = 0.0;             ///< of the bias alone, 0 when none is seen
    double smallest_visible = 0.0;   ///< a bias beneath this would not have been seen
    std::optional<double> seconds{}; ///< when noise falls below the bias, if that was reached
};
/// `reference` is the reference's own error. A bias counts when the chance of seeing one that is
/// not there is below 1e-3.
BiasFloor bias_floor(const ErrorCurve& curve, const RelmseEstimate& reference);

} // namespace reradiant
