#pragma once

#include "host/base/interruption.h"

#include <Eigen/Core>

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace ceres {
class Problem;
}

namespace reradiant {

class SolveJournal;

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

struct SolverSettings {
    int most_iterations = 400;
    double kkt_tolerance = 1e-8;
    double most_seconds = 60.0;
    StopFlag stop = nullptr;         ///< asked before every step
    SolveJournal* journal = nullptr; ///< keeps every step, and has those of an earlier run
};

/// A `SolveTrace` says how a minimisation went.
struct SolveTrace {
    std::vector<double> cost, seconds; ///< after every step; seconds since `start`
    int iterations = 0;
    double kkt = 0.0; ///< see kkt_violation
    bool converged = false;
    std::string stop_reason;

    /// Appends steps that went on from the end of these.
    void append(const SolveTrace& more);
    double final_cost() const { return cost.empty() ? 0.0 : cost.back(); }
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
