#pragma once

#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// Non-negative functions on the bands of a grid whose non-negative sums make curves.
struct SmoothBasis {
    double spacing_nm = 0.0; ///< of splines; 0: one number a band or a knot
    Eigen::MatrixXd values;  ///< (bands, functions)
    std::vector<int> knots;  ///< bands of the hat functions, ascending; empty: there are none

    Eigen::Index size() const { return values.cols(); }
    bool is_per_band() const { return spacing_nm == 0.0 && knots.empty(); }
};

/// One function a band.
SmoothBasis per_band_basis(const WavelengthGrid& grid);

/// Uniform cubic B-splines (de Boor 1978) at band centres: function j is centred at
/// from + (j - 1) spacing; they sum to 1. A spacing up to the grid's step gives per_band_basis.
SmoothBasis spline_basis(const WavelengthGrid& grid, double spacing_nm);

/// Hat functions: 1 at a knot of their own, linear to the knots beside it, so that a curve is zero
/// before the first knot and beyond the last. `knots`: ascending bands, at least one.
SmoothBasis hat_basis(const WavelengthGrid& grid, std::vector<int> knots);

/// The uniform cubic B-spline with knots -2, -1, 0, 1, 2.
double cubic_spline(double t);

} // namespace reradiant
