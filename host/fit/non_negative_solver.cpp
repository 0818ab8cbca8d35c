#include "host/fit/non_negative_solver.h"

#include "host/fit/bounded_quadratic.h"

#include <ceres/crs_matrix.h>
#include <ceres/problem.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace reradiant {

namespace {

using Vector = Eigen::VectorXd;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Cost and derivatives at a point.
struct LocalModel {
    double cost = 0.0;
    Vector gradient, curvature;         ///< curvature: diagonal of `normal`
    Eigen::SparseMatrix<double> normal; ///< J' J

    /// The quadratic of a step from `parameters`, damped in units of the curvatures, as a function
    /// of the parameters at the step's end. One that nothing depends on stays where it is.
    Quadratic damped(const Vector& parameters, double damping) const {
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
    Linearisation(const NonNegativeModel& model, const Vector& start,
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
    double cost_at(const Vector& point) {
        values_ = point;
        double value = 0.0;
        const bool good = problem_.Evaluate(options_, &value, nullptr, nullptr, nullptr);
        return good && std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
    }

    /// Cost and its derivatives by some blocks, all where `blocks` is empty; nothing where they are
    /// not defined.
    std::optional<LocalModel> linearise(const Vector& point, const std::vector<double*>& blocks) {
        values_ = point;
        LocalModel local;
        std::vector<double> slope;
        ceres::CRSMatrix crs;
        ceres::Problem::EvaluateOptions options = options_;
        if (!blocks.empty())
            options.parameter_blocks = blocks;
        if (!problem_.Evaluate(options, &local.cost, nullptr, &slope, &crs))
            return std::nullopt;
        local.gradient =
            Eigen::Map<const Vector>(slope.data(), static_cast<Eigen::Index>(slope.size()));
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
    Vector values_;
    ceres::Problem problem_;
    ceres::Problem::EvaluateOptions options_;
};

/// Damping of the next step, relative to the curvatures (Nielsen 1999).
class Damping {
public:
    double value() const { return value_; }
    void accept(double gain) {
        value_ *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * gain - 1.0, 3.0));
        value_ = std::max(value_, least);
        growth_ = 2.0;
    }
    void refuse() {
        value_ *= growth_;
        growth_ *= 2.0;
    }
    bool is_hopeless() const { return value_ > 1e12; }

private:
    /// Factors may be mixed at no cost: with less the normal equations are singular there.
    static constexpr double least = 1e-10;
    double value_ = 1e-3, growth_ = 2.0;
};

/// Relative change of a cost that is a sum of thousands of squares and may be rounding alone.
constexpr double cost_rounding = 1e-14;
/// KKT violation that still counts as convergence when rounding keeps the cost from falling.
constexpr double kkt_of_rounding = 1e-6;
/// Damping of the affine blocks alone, only against singular ones.
constexpr double ridge = 1e-12;
/// Steps in a row that change nothing beyond rounding.
constexpr int most_idle_steps = 8;

std::vector<bool> bounded_parameters(const NonNegativeModel& model, Eigen::Index count) {
    std::vector<bool> bounded(static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < bounded.size(); ++k)
        bounded[k] = !model.may_be_negative(static_cast<Eigen::Index>(k));
    return bounded;
}

/// One minimisation.
class Descent {
public:
    Descent(const NonNegativeModel& model, Vector& parameters, const SolverSettings& settings,
            Clock::time_point start)
        : model_(model), parameters_(parameters), settings_(settings), start_(start),
          begin_(Clock::now()), bounded_(bounded_parameters(model, parameters.size())),
          problem_(model, parameters, settings) {
        for (Eigen::Index k = 0; k < parameters_.size(); ++k)
            if (bounded_[static_cast<std::size_t>(k)])
                parameters_(k) = std::max(parameters_(k), 0.0);
    }

    SolveTrace run() {
        while (auto local = problem_.linearise(parameters_, {})) {
            here_ = std::move(*local);
            note();
            if (must_stop())
                return trace_;
            take_step();
        }
        trace_.converged = false;
        trace_.stop_reason = "the cost or its slope is not finite";
        return trace_;
    }

private:
    void note() {
        ++trace_.iterations;
        trace_.cost.push_back(here_.cost);
        trace_.seconds.push_back(seconds_since(start_));
        trace_.kkt = kkt_violation(parameters_, here_.gradient, here_.curvature, model_);
    }

    bool must_stop() {
        throw_if_stopped(settings_.stop);
        trace_.converged = trace_.kkt <= settings_.kkt_tolerance;
        if (trace_.converged) {
            trace_.stop_reason =
                fmt::format("the KKT conditions hold to {:.1e}", settings_.kkt_tolerance);
        } else if (idle_ >= most_idle_steps || damping_.is_hopeless()) {
            trace_.converged = trace_.kkt <= kkt_of_rounding;
            trace_.stop_reason = fmt::format(
                "no step lowers the cost any more; the KKT conditions hold to {:.1e}", trace_.kkt);
        } else if (seconds_since(begin_) > settings_.most_seconds) {
            trace_.stop_reason = "the limit of time was reached";
        } else if (trace_.iterations >= settings_.most_iterations) {
            trace_.stop_reason = "the limit of iterations was reached";
        }
        return !trace_.stop_reason.empty();
    }

    /// Tries steps of growing damping until one does not raise the cost.
    void take_step() {
        const bool dense = model_.linear_algebra().type != LinearAlgebra::Type::SparseNormal;
        while (!damping_.is_hopeless()) {
            std::vector<bool> free = free_at(parameters_, 0, parameters_.size());
            const auto target = minimise_quadratic(here_.damped(parameters_, damping_.value()),
                                                   bounded_, dense, free);
            if (target && accepts(*target))
                return;
            damping_.refuse();
        }
    }

    std::vector<bool> free_at(const Vector& point, Eigen::Index first, Eigen::Index count) const {
        std::vector<bool> free(static_cast<std::size_t>(count));
        for (std::size_t k = 0; k < free.size(); ++k) {
            const Eigen::Index parameter = first + static_cast<Eigen::Index>(k);
            free[k] = !bounded_[static_cast<std::size_t>(parameter)] || point(parameter) > 0.0;
        }
        return free;
    }

    /// Solves for the affine blocks at a point; returns the cost there.
    double settle_affine(Vector& point) {
        const double cost = problem_.cost_at(point);
        const auto [first, count] = model_.affine_blocks();
        if (count == 0)
            return cost;
        const auto begin = problem_.blocks().begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<double*> blocks(begin, begin + static_cast<std::ptrdiff_t>(count));
        const auto local = problem_.linearise(point, blocks);
        if (!local)
            return cost;
        const Eigen::Index size = local->gradient.size(), offset = blocks.front() - problem_.data();
        std::vector<bool> free = free_at(point, offset, size);
        const std::vector<bool> bounded(bounded_.begin() + offset,
                                        bounded_.begin() + offset + size);
        const auto settled = minimise_quadratic(local->damped(point.segment(offset, size), ridge),
                                                bounded, false, free);
        if (!settled)
            return cost;
        Vector moved = point;
        moved.segment(offset, size) = *settled;
        const double lower = problem_.cost_at(moved);
        if (!(lower < cost))
            return cost;
        point = moved;
        return lower;
    }

    bool accepts(Vector target) {
        const Vector step = target - parameters_;
        const double cost = settle_affine(target);
        const double expected = -here_.gradient.dot(step) - 0.5 * step.dot(here_.normal * step);
        const double rounding = cost_rounding * here_.cost;
        if (!(cost <= here_.cost + rounding))
            return false;
        damping_.accept(expected > rounding ? std::min(1.0, (here_.cost - cost) / expected) : 1.0);
        idle_ = here_.cost - cost > rounding ? 0 : idle_ + 1;
        parameters_ = target;
        return true;
    }

    const NonNegativeModel& model_;
    Vector& parameters_;
    const SolverSettings& settings_;
    Clock::time_point start_, begin_;
    std::vector<bool> bounded_;
    Linearisation problem_;
    LocalModel here_;
    Damping damping_;
    SolveTrace trace_;
    int idle_ = 0;
};

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
    return Descent(model, parameters, settings, start).run();
}

} // namespace reradiant
