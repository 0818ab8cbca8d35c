#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <optional>
#include <vector>

namespace reradiant {

/// A convex quadratic 1/2 y' H y + c' y, H (n, n) symmetric and positive definite, both triangles.
template <typename Hessian>
struct Quadratic {
    Hessian h;
    Eigen::VectorXd c;
};

/// Its minimiser with y(k) >= 0 wherever `bounded(k)`, by block principal pivoting (Judice and
/// Pires 1994): all wrong signs are exchanged at once, and singly (Murty 1974, which ends) when
/// that does not lessen them. `free` holds the first guess of what is not at zero and receives the
/// answer. Nothing when H is not positive definite to rounding, or so nearly singular that 12
/// exchanges do not end: damp it more.
template <typename Hessian>
std::optional<Eigen::VectorXd> minimise_quadratic(const Quadratic<Hessian>& quadratic,
                                                  const std::vector<bool>& bounded,
                                                  std::vector<bool>& free);

extern template std::optional<Eigen::VectorXd>
minimise_quadratic(const Quadratic<Eigen::MatrixXd>&, const std::vector<bool>&, std::vector<bool>&);
extern template std::optional<Eigen::VectorXd>
minimise_quadratic(const Quadratic<Eigen::SparseMatrix<double>>&, const std::vector<bool>&,
                   std::vector<bool>&);

} // namespace reradiant
