#pragma once

#include "host/fit/bounded_quadratic.h"
#include "host/fit/non_negative_solver.h"

#include <Eigen/SparseCore>
#include <ceres/crs_matrix.h>
#include <ceres/problem.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace reradiant {

/// Cost and derivatives at a point.
struct LocalModel {
    double cost = 0.0;
    Eigen::VectorXd gradient, curvature; ///< curvature: diagonal of `normal`
    Eigen::SparseMatrix<double> normal;  ///< J' J

    /// The quadratic of a step from `parameters`, damped in units of the curvatures, as a function
    /// of the parameters at the step's end. One that nothing depends on stays where it is.
    Quadratic damped(const Eigen::VectorXd& parameters, double damping) const {
        Quadratic quadratic{normal, {}};
        for (Eigen::Index k = 0; k < parameters.size(); ++k)
            quadratic.h.coeffRef(k, k) += curvature(k) > 0.0 ? damping * curvature(k) : 1.0;
        quadratic.c = gradient - quadratic.h * parameters;
        return quadratic;
    }
};

/// The Ceres problem of a model with its parameters in one vector. Ceres evaluates residuals,
/// losses and Jacobians.
class Linearisation {
public:
    Linearisation(const NonNegativeModel& model, const Eigen::VectorXd& start,
                  const SolverSettings& settings)
        : values_(start) {
        double* next = values_.data();
        for (const int size : model.block_sizes()) {
            options_.parameter_blocks.push_back(next);
            problem_.AddParameterBlock(next, size);
            next += size;
        }
        options_.num_threads = settings.threads;
        model.add_residuals(problem_, options_.parameter_blocks);
    }

    /// Cost at a point, infinite where a residual cannot be evaluated.
    double cost_at(const Eigen::VectorXd& point) {
        values_ = point;
        double value = 0.0;
        const bool good = problem_.Evaluate(options_, &value, nullptr, nullptr, nullptr);
        return good && std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
    }

    /// Cost and its derivatives by some blocks, all where `blocks` is empty; nothing where they are
    /// not defined.
    std::optional<LocalModel> linearise(const Eigen::VectorXd& point,
                                        const std::vector<double*>& blocks) {
        values_ = point;
        LocalModel local;
        std::vector<double> slope;
        ceres::CRSMatrix crs;
        ceres::Problem::EvaluateOptions options = options_;
        if (!blocks.empty())
            options.parameter_blocks = blocks;
        if (!problem_.Evaluate(options, &local.cost, nullptr, &slope, &crs))
            return std::nullopt;
        local.gradient = Eigen::Map<const Eigen::VectorXd>(slope.data(),
                                                           static_cast<Eigen::Index>(slope.size()));
        const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> jacobian(
            crs.num_rows, crs.num_cols, static_cast<Eigen::Index>(crs.values.size()),
            crs.rows.data(), crs.cols.data(), crs.values.data());
        const Eigen::SparseMatrix<double> columns(jacobian);
        local.normal = columns.transpose() * columns;
        local.curvature = local.normal.diagonal();
        if (!std::isfinite(local.cost) || !local.gradient.allFinite())
            return std::nullopt;
        return local;
    }

    const double* data() const { return values_.data(); }
    const std::vector<double*>& blocks() const { return options_.parameter_blocks; }

private:
    Eigen::VectorXd values_;
    ceres::Problem problem_;
    ceres::Problem::EvaluateOptions options_;
};

} // namespace reradiant
