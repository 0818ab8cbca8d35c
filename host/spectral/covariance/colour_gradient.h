#pragma once

#include "reradiant/colour_of_matrix.h"

#include <Eigen/Core>

namespace reradiant {

/// X, Y and Z of a matrix, and its R457, are sums over its entries of a weight times the entry.
/// Returns the weights, (entries in column-major order, 3; 4 with R457), for one illuminant:
/// weights.transpose() * entries is what colour_of_matrix and r457 give. `like` gives the bands;
/// its values do not count. The sums are those of `sum` with MatrixColour::at_nanometres.
Eigen::MatrixXd colour_gradient(const ReradiationMatrix& like, const Spectrum& illuminant,
                                ColourSum sum, bool at_nanometres,
                                const ColourConditions& conditions, bool with_r457);

} // namespace reradiant
