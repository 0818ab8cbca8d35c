#pragma once

#include "reradiant/fit.h"

#include <Eigen/Core>

#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

namespace ceres {
class Problem;
}

namespace reradiant {

/// `LinearAlgebra` says how the linear systems of a step are solved.
struct LinearAlgebra {
    enum class Type { DenseNormal, SparseNormal } type = Type::DenseNormal;
};

/// A least-squares problem whose parameters may not be negative (unless free). The parameters form
/// one vector of consecutive blocks.
class NonNegativeModel {
public:
    virtual ~NonNegativeModel() = default;
    virtual std::vector<int> block_sizes() const = 0;
    virtual bool may_be_negative(Eigen::Index /*parameter*/) const { return false; }
    virtual void add_residuals(ceres::Problem& problem,
                               const std::vector<double*>& blocks) const = 0;
    virtual LinearAlgebra linear_algebra() const { return {}; }
    /// Blocks in which the residuals are affine while the others stay: first, and how many.
    virtual std::pair<std::size_t, std::size_t> affine_blocks() const { return {0, 0}; }
};

/// Largest move that a projected step along a single parameter (of its Gauss-Newton length) would
/// still make, relative to the largest parameter of its block: 0 at a KKT point, and free of units.
double kkt_violation(const Eigen::VectorXd& parameters, const Eigen::VectorXd& gradient,
                     const Eigen::VectorXd& curvature, const NonNegativeModel& model);

/// Minimises by Levenberg-Marquardt steps whose quadratic is minimised exactly under the bounds
/// (bounded_quadratic.h): the bounds of Ceres 2.1 stop at wrong points (cases 45 to 47 of
/// tests/README.md), so Ceres evaluates residuals, losses and Jacobians, and the steps are taken
/// here. After each step the affine blocks are solved for (Ruhe and Wedin 1980, algorithm 2):
/// factors may be mixed at almost no cost, and a step of both factors at once leaves that curved
/// valley. Ends when the KKT conditions hold to the tolerance, or to 1e-6 where rounding keeps the
/// cost from falling or, at the limit of iterations, a hundred steps lower it by less than 0.01, a
/// hundredth of what noise does. Never raises the cost beyond rounding.
SolveTrace minimise_non_negative(const NonNegativeModel& model, Eigen::VectorXd& parameters,
                                 const SolverSettings& settings,
                                 std::chrono::steady_clock::time_point start);

} // namespace reradiant
