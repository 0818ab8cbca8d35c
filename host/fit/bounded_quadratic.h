#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <optional>
#include <vector>

namespace reradiant {

/// A convex quadratic 1/2 y' H y + c' y, H (n, n) symmetric and positive definite.
struct Quadratic {
    Eigen::SparseMatrix<double> h; ///< both triangles
    Eigen::VectorXd c;
};

/// Its minimiser with y(k) >= 0 wherever `bounded(k)`, by block principal pivoting (Judice and
/// Pires 1994): all wrong signs are exchanged at once, and singly (Murty 1974, which ends) when
/// that does not lessen them. `free` holds the first guess of what is not at zero and receives the
/// answer. `dense`: H is best factorised as a full matrix. Nothing when H is not positive definite
/// to rounding, or so nearly singular that 12 exchanges do not end: damp it more.
std::optional<Eigen::VectorXd> minimise_quadratic(const Quadratic& quadratic,
                                                  const std::vector<bool>& bounded, bool dense,
                                                  std::vector<bool>& free);

} // namespace reradiant
