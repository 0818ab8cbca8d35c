#include "host/fit/non_negative_solver.h"

#include <ceres/crs_matrix.h>
#include <ceres/manifold.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

namespace reradiant {

namespace {

using Vector = Eigen::VectorXd;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The Ceres problem of a model with its parameters in one vector.
class Minimisation {
public:
    Minimisation(const NonNegativeModel& model, const Vector& start, const SolverSettings& settings)
        : model_(model), settings_(settings), sizes_(model.block_sizes()), values_(start) {
        double* next = values_.data();
        for (const int size : sizes_) {
            blocks_.push_back(next);
            problem_.AddParameterBlock(next, size);
            next += size;
        }
        model.add_residuals(problem_, blocks_);
    }

    /// Cost at a point, infinite where a residual cannot be evaluated.
    double cost_at(const Vector& point) {
        const Vector kept = values_;
        values_ = point;
        free_all();
        double cost = 0.0;
        const bool good = problem_.Evaluate(evaluate_options(), &cost, nullptr, nullptr, nullptr);
        values_ = kept;
        return good && std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
    }

    /// Cost, its gradient and the diagonal of J^T J at the current point; false where undefined.
    bool linearise(double& cost, Vector& gradient, Vector& curvature) {
        free_all();
        std::vector<double> slope;
        ceres::CRSMatrix jacobian;
        if (!problem_.Evaluate(evaluate_options(), &cost, nullptr, &slope, &jacobian))
            return false;
        gradient = Eigen::Map<const Vector>(slope.data(), static_cast<Eigen::Index>(slope.size()));
        curvature = Vector::Zero(gradient.size());
        for (std::size_t k = 0; k < jacobian.values.size(); ++k)
            curvature(jacobian.cols[k]) += jacobian.values[k] * jacobian.values[k];
        return std::isfinite(cost) && gradient.allFinite();
    }

    /// Unbounded minimisation over the parameters that are not held.
    ceres::Solver::Summary solve(const std::vector<bool>& held, int steps, double seconds) {
        hold(held);
        ceres::Solver::Options options;
        options.max_num_iterations = steps;
        options.max_solver_time_in_seconds = seconds;
        options.function_tolerance = 1e-16;
        options.gradient_tolerance = 1e-14;
        options.parameter_tolerance = 1e-14;
        options.initial_trust_region_radius = radius_;
        options.num_threads = settings_.threads;
        options.logging_type = ceres::SILENT;
        options.min_lm_diagonal = 1e-9;
        // Near the optimum a step changes the cost by less than its rounding.
        options.use_nonmonotonic_steps = true;
        set_linear_algebra(options);
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem_, &summary);
        if (!summary.iterations.empty())
            radius_ = std::clamp(summary.iterations.back().trust_region_radius, 1.0, 1e16);
        free_all();
        return summary;
    }

    Vector& values() { return values_; }

private:
    ceres::Problem::EvaluateOptions evaluate_options() const {
        ceres::Problem::EvaluateOptions options;
        options.parameter_blocks = blocks_;
        options.num_threads = settings_.threads;
        return options;
    }

    void free_all() {
        for (double* block : held_blocks_) {
            problem_.SetParameterBlockVariable(block);
            problem_.SetManifold(block, nullptr);
        }
        held_blocks_.clear();
    }

    void hold(const std::vector<bool>& held) {
        free_all();
        std::size_t next = 0;
        for (std::size_t b = 0; b < blocks_.size(); ++b) {
            std::vector<int> constant;
            for (int k = 0; k < sizes_[b]; ++k)
                if (held[next++])
                    constant.push_back(k);
            if (constant.empty())
                continue;
            held_blocks_.push_back(blocks_[b]);
            if (static_cast<int>(constant.size()) == sizes_[b])
                problem_.SetParameterBlockConstant(blocks_[b]);
            else
                problem_.SetManifold(blocks_[b], new ceres::SubsetManifold(sizes_[b], constant));
        }
    }

    void set_linear_algebra(ceres::Solver::Options& options) const {
        const LinearAlgebra algebra = model_.linear_algebra();
        switch (algebra.type) {
        case LinearAlgebra::Type::DenseNormal:
            options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
            break;
        case LinearAlgebra::Type::SparseNormal:
            options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
            break;
        case LinearAlgebra::Type::DenseSchur:
            options.linear_solver_type = ceres::DENSE_SCHUR;
            options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
            for (std::size_t b = 0; b < blocks_.size(); ++b)
                options.linear_solver_ordering->AddElementToGroup(
                    blocks_[b], b < algebra.eliminated_blocks ? 0 : 1);
            break;
        }
    }

    const NonNegativeModel& model_;
    const SolverSettings& settings_;
    std::vector<int> sizes_;
    Vector values_;
    ceres::Problem problem_;
    std::vector<double*> blocks_, held_blocks_;
    double radius_ = 1e4;
};

Vector projected(const Vector& point, const NonNegativeModel& model) {
    Vector result = point;
    for (Eigen::Index k = 0; k < result.size(); ++k)
        if (result(k) < 0.0 && !model.may_be_negative(k))
            result(k) = 0.0;
    return result;
}

/// Relative change of a cost that is a sum of thousands of squares and may be rounding alone.
constexpr double cost_rounding = 1e-14;
/// KKT violation that still counts as convergence when rounding keeps the cost from falling.
constexpr double kkt_of_rounding = 1e-6;

/// Towards `target`, cut off at zero, as far as the cost does not rise; `from` when it always does.
Vector projected_step(Minimisation& minimisation, const NonNegativeModel& model, const Vector& from,
                      const Vector& target, double cost_now) {
    for (double share = 1.0; share > 1e-7; share *= 0.3) {
        const Vector trial = projected(from + share * (target - from), model);
        if (minimisation.cost_at(trial) <= cost_now * (1.0 + cost_rounding))
            return trial;
    }
    return from;
}

std::vector<bool> held_at_zero(const Vector& values, const Vector& gradient,
                               const Vector& curvature, const NonNegativeModel& model) {
    std::vector<bool> held(static_cast<std::size_t>(values.size()));
    for (Eigen::Index k = 0; k < values.size(); ++k)
        // A parameter that nothing depends on stays where it is, too: no step could be computed.
        held[static_cast<std::size_t>(k)] =
            curvature(k) == 0.0 ||
            (values(k) <= 0.0 && gradient(k) >= 0.0 && !model.may_be_negative(k));
    return held;
}

void record(SolveTrace& trace, const ceres::Solver::Summary& summary, double seconds_before) {
    for (std::size_t k = 1; k < summary.iterations.size(); ++k) {
        trace.cost.push_back(summary.iterations[k].cost);
        trace.seconds.push_back(seconds_before + summary.iterations[k].cumulative_time_in_seconds);
        ++trace.iterations;
    }
}

/// Why a minimisation ends at a point, or nothing. Fills trace.converged.
std::optional<std::string> reason_to_stop(SolveTrace& trace, const SolverSettings& settings,
                                          bool is_stuck, double seconds) {
    trace.converged = trace.kkt <= settings.kkt_tolerance;
    if (trace.converged)
        return fmt::format("the KKT conditions hold to {:.1e}", settings.kkt_tolerance);
    if (is_stuck) {
        trace.converged = trace.kkt <= kkt_of_rounding;
        return fmt::format("no step lowers the cost any more; the KKT conditions hold to {:.1e}",
                           trace.kkt);
    }
    if (seconds > settings.most_seconds)
        return "the limit of time was reached";
    if (trace.iterations >= settings.most_iterations)
        return "the limit of iterations was reached";
    return std::nullopt;
}

} // namespace

double kkt_violation(const Vector& parameters, const Vector& gradient, const Vector& curvature,
                     const NonNegativeModel& model) {
    double worst = 0.0;
    Eigen::Index k = 0;
    const double largest = std::max(parameters.cwiseAbs().maxCoeff(), 1e-300);
    for (const int size : model.block_sizes())
        for (int j = 0; j < size; ++j, ++k) {
            if (curvature(k) == 0.0)
                continue;
            double step = -gradient(k) / curvature(k);
            if (!model.may_be_negative(k))
                step = std::max(step, -parameters(k));
            worst = std::max(worst, std::abs(step) / largest);
        }
    return worst;
}

SolveTrace minimise_non_negative(const NonNegativeModel& model, Vector& parameters,
                                 const SolverSettings& settings, Clock::time_point start) {
    const Clock::time_point begin = Clock::now();
    parameters = projected(parameters, model);
    Minimisation minimisation(model, parameters, settings);
    SolveTrace trace;
    double cost = 0.0, last_cost = std::numeric_limits<double>::infinity();
    double last_kkt = std::numeric_limits<double>::infinity();
    Vector gradient, curvature;
    for (;;) {
        if (!minimisation.linearise(cost, gradient, curvature)) {
            trace.stop_reason = "the cost or its slope is not finite";
            return trace;
        }
        trace.cost.push_back(cost);
        trace.seconds.push_back(seconds_since(start));
        trace.kkt = kkt_violation(parameters, gradient, curvature, model);
        const bool is_stuck =
            cost >= last_cost * (1.0 - cost_rounding) && trace.kkt > 0.5 * last_kkt;
        if (const auto reason =
                reason_to_stop(trace, settings, is_stuck, seconds_since(begin))) {
            trace.stop_reason = *reason;
            return trace;
        }
        last_cost = cost;
        last_kkt = trace.kkt;
        const ceres::Solver::Summary summary = minimisation.solve(
            held_at_zero(parameters, gradient, curvature, model),
            std::min(settings.steps_per_round, settings.most_iterations - trace.iterations),
            settings.most_seconds);
        record(trace, summary, seconds_since(start) - summary.total_time_in_seconds);
        if (summary.termination_type == ceres::FAILURE) {
            trace.stop_reason = "Ceres failed: " + summary.message;
            return trace;
        }
        parameters = projected_step(minimisation, model, parameters, minimisation.values(), cost);
        minimisation.values() = parameters;
    }
}

} // namespace reradiant
