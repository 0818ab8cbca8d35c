#pragma once

#include "host/spectral/grid.h"

#include <Eigen/Core>

namespace reradiant {

/// Non-negative functions on the bands of a grid whose non-negative sums make curves.
struct SmoothBasis {
    double spacing_nm = 0.0; ///< of the functions; 0: one number a band, nothing is smoothed
    Eigen::MatrixXd values;  ///< (bands, functions)

    Eigen::Index size() const { return values.cols(); }
    bool is_per_band() const { return spacing_nm == 0.0; }
};

/// One function a band.
SmoothBasis per_band_basis(const WavelengthGrid& grid);

/// Uniform cubic B-splines (de Boor 1978) at band centres: function j is centred at
/// from + (j - 1) spacing; they sum to 1. A spacing up to the grid's step gives per_band_basis.
SmoothBasis spline_basis(const WavelengthGrid& grid, double spacing_nm);

/// The uniform cubic B-spline with knots -2, -1, 0, 1, 2.
double cubic_spline(double t);

} // namespace reradiant
