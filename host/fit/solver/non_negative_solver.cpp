#include "host/fit/solver/non_negative_solver.h"

#include "host/fit/solver/bounded_quadratic.h"
#include "host/fit/solver/linearisation.h"
#include "host/fit/solver/solve_journal.h"

#include <fmt/core.h>

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
    void keep_in(SolveState& state) const {
        state.damping = value_;
        state.damping_growth = growth_;
    }
    void restore(const SolveState& state) {
        value_ = state.damping;
        growth_ = state.damping_growth;
    }

private:
    /// Factors may be mixed at no cost: with less the normal equations are singular there.
    static constexpr double least = 1e-10;
    double value_ = 1e-3, growth_ = 2.0;
};

/// Relative change of a cost that is a sum of thousands of squares and may be rounding alone.
constexpr double cost_rounding = 1e-14;
/// KKT violation that still counts as convergence when rounding keeps the cost from falling.
constexpr double kkt_of_rounding = 1e-6;
/// Fall of the cost over a hundred steps that ends a valley at the limit of iterations.
constexpr double hardly = 0.01;
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

/// One minimisation, with full or with sparse normal equations.
template <typename Hessian>
class Descent {
public:
    Descent(const NonNegativeModel& model, Vector& parameters, const SolverSettings& settings,
            Clock::time_point start)
        : model_(model), parameters_(parameters), settings_(settings), start_(start),
          begin_(Clock::now()), bounded_(bounded_parameters(model, parameters.size())),
          problem_(model, parameters) {
        for (Eigen::Index k = 0; k < parameters_.size(); ++k)
            if (bounded_[static_cast<std::size_t>(k)])
                parameters_(k) = std::max(parameters_(k), 0.0);
    }

    SolveTrace run() {
        if (settings_.journal != nullptr && goes_on())
            return trace_;
        while (auto local = problem_.linearise<Hessian>(parameters_, {0, parameters_.size()})) {
            here_ = std::move(*local);
            note();
            if (must_stop()) {
                keep(true);
                return trace_;
            }
            take_step();
            keep(false);
        }
        trace_.converged = false;
        trace_.stop_reason = "the cost or its slope is not finite";
        keep(true);
        return trace_;
    }

private:
    /// Takes the state of an earlier run; true when that came to the end.
    bool goes_on() {
        const SolveState state = settings_.journal->begin(parameters_);
        kept_start_ = state.start;
        if (!state.is_done && state.trace.iterations == 0)
            return false;
        parameters_ = state.parameters;
        trace_ = state.trace;
        damping_.restore(state);
        idle_ = state.idle_steps;
        seconds_before_ = state.seconds;
        return state.is_done;
    }

    void keep(bool is_done) {
        if (settings_.journal == nullptr)
            return;
        SolveState state{kept_start_, parameters_, trace_, 0.0, 0.0, seconds(), idle_, is_done};
        damping_.keep_in(state);
        settings_.journal->note(std::move(state));
    }

    double seconds() const { return seconds_before_ + seconds_since(begin_); }

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
                fmt::format("the conditions of a minimum hold to {:.1e}", settings_.kkt_tolerance);
        } else if (idle_ >= most_idle_steps || damping_.is_hopeless()) {
            trace_.converged = trace_.kkt <= kkt_of_rounding;
            trace_.stop_reason = fmt::format(
                "no step lowers the cost any more; the conditions of a minimum hold to {:.1e}",
                trace_.kkt);
        } else if (seconds() > settings_.most_seconds) {
            trace_.stop_reason = "the limit of time was reached";
        } else if (trace_.iterations >= settings_.most_iterations) {
            trace_.converged = trace_.kkt <= kkt_of_rounding && hardly_falls();
            trace_.stop_reason =
                trace_.converged
                    ? fmt::format(
                          "the limit of iterations was reached, where a hundred steps lower "
                          "the cost by less than {}; the conditions of a minimum hold to {:.1e}",
                          hardly, trace_.kkt)
                    : "the limit of iterations was reached";
        }
        return !trace_.stop_reason.empty();
    }

    /// Noise moves the cost by about 1: what a valley still falls by says nothing of the data.
    bool hardly_falls() const {
        const auto& cost = trace_.cost;
        return cost.size() > 100 && cost[cost.size() - 101] - cost.back() < hardly;
    }

    /// Tries steps of growing damping until one does not raise the cost.
    void take_step() {
        while (!damping_.is_hopeless()) {
            std::vector<bool> free = free_at(parameters_, 0, parameters_.size());
            const auto target =
                minimise_quadratic(here_.damped(parameters_, damping_.value()), bounded_, free);
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
        const auto [first_block, blocks] = model_.affine_blocks();
        if (blocks == 0)
            return cost;
        // Next to diagonal, since hardly two of them share a residual.
        const ParameterRange range = problem_.range_of(first_block, blocks);
        const auto local = problem_.linearise<Eigen::SparseMatrix<double>>(point, range);
        if (!local)
            return cost;
        const auto [offset, size] = range;
        std::vector<bool> free = free_at(point, offset, size);
        const std::vector<bool> bounded(bounded_.begin() + offset,
                                        bounded_.begin() + offset + size);
        const auto settled =
            minimise_quadratic(local->damped(point.segment(offset, size), ridge), bounded, free);
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
    LocalModel<Hessian> here_;
    Damping damping_;
    SolveTrace trace_;
    int idle_ = 0;
    Vector kept_start_;
    double seconds_before_ = 0.0; ///< seconds that an earlier run took
};

} // namespace

void SolveTrace::append(const SolveTrace& more) {
    cost.insert(cost.end(), more.cost.begin(), more.cost.end());
    seconds.insert(seconds.end(), more.seconds.begin(), more.seconds.end());
    iterations += more.iterations;
    kkt = more.kkt;
    converged = more.converged;
    stop_reason = more.stop_reason;
}

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
    if (model.linear_algebra().type == LinearAlgebra::Type::SparseNormal)
        return Descent<Eigen::SparseMatrix<double>>(model, parameters, settings, start).run();
    return Descent<Eigen::MatrixXd>(model, parameters, settings, start).run();
}

} // namespace reradiant
