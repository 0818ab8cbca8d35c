#pragma once

#include <Eigen/Core>

#include <chrono>
#include <string>
#include <vector>

namespace ceres {
class Problem;
}

namespace reradiant {

/// How Ceres solves the linear system of a step.
struct LinearAlgebra {
    enum class Type { DenseNormal, SparseNormal, DenseSchur } type = Type::DenseNormal;
    std::size_t eliminated_blocks = 0; ///< DenseSchur: the first blocks, no two in one residual
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
};

struct SolverSettings {
    int most_iterations = 400; ///< Ceres steps, over all rounds
    int steps_per_round = 25;
    double kkt_tolerance = 1e-8;
    double most_seconds = 60.0;
    int threads = 1;
};

/// How a minimisation went.
struct SolveTrace {
    std::vector<double> cost, seconds; ///< after every step; seconds since `start`
    int iterations = 0;
    double kkt = 0.0; ///< see kkt_violation
    bool converged = false;
    std::string stop_reason;

    double final_cost() const { return cost.empty() ? 0.0 : cost.back(); }
};

/// Largest move that a projected step along a single parameter (of its Gauss-Newton length) would
/// still make, relative to the largest parameter of its block: 0 at a KKT point, and free of units.
double kkt_violation(const Eigen::VectorXd& parameters, const Eigen::VectorXd& gradient,
                     const Eigen::VectorXd& curvature, const NonNegativeModel& model);

/// Minimises by rounds: parameters that sit at zero with a gradient that holds them there are taken
/// out of the problem, Ceres minimises the others without bounds (its own bounds stop at wrong
/// points, CASES 45 to 47), and what came out negative is set to zero, all at once if that lowers
/// the cost, else by a shorter step. Ends when the KKT conditions hold. Never raises the cost.
SolveTrace minimise_non_negative(const NonNegativeModel& model, Eigen::VectorXd& parameters,
                                 const SolverSettings& settings,
                                 std::chrono::steady_clock::time_point start);

} // namespace reradiant
