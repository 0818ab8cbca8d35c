#pragma once

#include "host/fit/solver/bounded_quadratic.h"
#include "host/fit/solver/non_negative_solver.h"

#include <Eigen/SparseCore>
#include <ceres/problem.h>

#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <vector>

namespace reradiant {

/// Cost and derivatives at a point.
template <typename Hessian>
struct LocalModel {
    double cost = 0.0;
    Eigen::VectorXd gradient, curvature; ///< curvature: diagonal of `normal`
    Hessian normal;                      ///< J' J, both triangles

    /// The quadratic of a step from `parameters`, damped in units of the curvatures, as a function
    /// of the parameters at the step's end. One that nothing depends on stays where it is.
    Quadratic<Hessian> damped(const Eigen::VectorXd& parameters, double damping) const {
        Quadratic<Hessian> quadratic{normal, {}};
        for (Eigen::Index k = 0; k < parameters.size(); ++k)
            quadratic.h.coeffRef(k, k) += curvature(k) > 0.0 ? damping * curvature(k) : 1.0;
        quadratic.c = gradient - quadratic.h * parameters;
        return quadratic;
    }
};

/// Consecutive parameters.
struct ParameterRange {
    Eigen::Index first = 0, count = 0;
};

/// The Ceres problem of a model with its parameters in one vector. Ceres evaluates residuals,
/// losses and Jacobians, one residual block at a time: Problem::Evaluate builds a new evaluator at
/// every call, which takes five times as long as the evaluation.
class Linearisation {
public:
    Linearisation(const NonNegativeModel& model, const Eigen::VectorXd& start);

    /// Cost at a point, infinite where a residual cannot be evaluated.
    double cost_at(const Eigen::VectorXd& point);

    /// Cost and its derivatives by some of the parameters; nothing where they are not defined.
    template <typename Hessian>
    std::optional<LocalModel<Hessian>> linearise(const Eigen::VectorXd& point,
                                                 const ParameterRange& range);

    /// Parameters of blocks that follow each other.
    ParameterRange range_of(std::size_t first_block, std::size_t blocks) const;

private:
    struct Residuals {
        ceres::ResidualBlockId id;
        int count;
        std::vector<std::pair<Eigen::Index, int>> blocks; ///< first parameter, how many
    };

    /// Rows of the Jacobian without their zeros.
    struct Rows {
        std::vector<int> begin{0}, column;
        std::vector<double> value;
    };

    bool append_rows(const Residuals& residuals, const ParameterRange& range, double& cost,
                     Eigen::VectorXd& gradient, Rows& rows);

    Eigen::VectorXd values_;
    ceres::Problem problem_;
    std::vector<Residuals> residuals_;
    std::vector<Eigen::Index> first_parameters_; ///< of every block, and the end
    std::vector<double> residual_, slope_;       ///< of one residual block
    std::vector<double*> slopes_;
};

} // namespace reradiant
