#include "host/fit/stack/unknown_stack.h"

#include "host/fit/stack/stack_response.h"
#include "host/spectral/matrix/singular_values.h"
#include "reradiant/error.h"

#include <ceres/crs_matrix.h>
#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <optional>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Central differences of a transport keep about nine digits.
constexpr double determined = 1e-6;
constexpr double nearly_the_same = 0.99; ///< correlation

/// Disagreement of the blocks, in standard errors: B itself is projected out.
class Disagreement {
public:
    Disagreement(const UnknownStack& unknown, const BispectralData& data,
                 const std::vector<Matrix>& weight)
        : unknown_(unknown), data_(data), weight_(weight) {
        for (const Matrix& block : weight)
            count_ += static_cast<int>((block.array() > 0.0).count());
    }

    int count() const { return count_; }
    /// Residuals less those that B takes: the degrees of freedom.
    double freedom() const {
        Matrix seen = Matrix::Zero(weight_.front().rows(), weight_.front().cols());
        for (const Matrix& block : weight_)
            seen.array() += (block.array() > 0.0).cast<double>();
        return std::max(1.0, count_ - static_cast<double>((seen.array() > 0.0).count()) -
                                 static_cast<double>(unknown_.count()));
    }

    /// False where the stack is impossible.
    bool operator()(double const* const* parameters, double* residuals) const {
        const Vector numbers = Eigen::Map<const Vector>(parameters[0], unknown_.count());
        try {
            const StackResponse response = stack_response(unknown_.stack(numbers), data_);
            const UncertainMatrix under = under_the_stack(data_, response, weight_);
            int next = 0;
            for (std::size_t b = 0; b < weight_.size(); ++b)
                for (Eigen::Index k = 0; k < weight_[b].size(); ++k)
                    if (weight_[b](k) > 0.0)
                        residuals[next++] =
                            std::sqrt(weight_[b](k)) *
                            (response.gain[b](k) * under.value(k) - data_.blocks[b].value(k));
        } catch (const Error&) {
            return false;
        }
        return true;
    }

private:
    const UnknownStack& unknown_;
    const BispectralData& data_;
    const std::vector<Matrix>& weight_;
    int count_ = 0;
};

Matrix jacobian_at(ceres::Problem& problem, double* numbers, Eigen::Index count) {
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = {numbers};
    ceres::CRSMatrix sparse;
    problem.Evaluate(options, nullptr, nullptr, nullptr, &sparse);
    Matrix dense = Matrix::Zero(sparse.num_rows, count);
    for (int row = 0; row < sparse.num_rows; ++row)
        for (int k = sparse.rows[static_cast<std::size_t>(row)];
             k < sparse.rows[static_cast<std::size_t>(row) + 1]; ++k)
            dense(row, sparse.cols[static_cast<std::size_t>(k)]) =
                sparse.values[static_cast<std::size_t>(k)];
    return dense;
}

/// Names of the numbers that a direction moves.
std::string moved_by(const UnknownStack& unknown, const Vector& direction) {
    std::vector<std::string> names;
    for (Eigen::Index k = 0; k < direction.size(); ++k)
        if (std::abs(direction(k)) > 0.1)
            names.push_back(unknown.name(k));
    return fmt::format("{}", fmt::join(names, " and "));
}

/// Covariance, correlations and what cannot be told apart, from the Jacobian at the optimum.
void judge(const Matrix& jacobian, double variance, const UnknownStack& unknown,
           UnknownStackFit& fit) {
    const Eigen::Index n = unknown.count();
    const Vector lengths = jacobian.colwise().norm().transpose().cwiseMax(1e-300);
    const ThinSvd svd = thin_svd(jacobian * lengths.cwiseInverse().asDiagonal());
    StackEstimate& estimate = fit.estimate;
    estimate.rank = static_cast<int>((svd.s.array() > determined * svd.s(0)).count());
    fit.root = lengths.cwiseInverse().asDiagonal() * svd.v.leftCols(estimate.rank) *
               (std::sqrt(variance) * svd.s.head(estimate.rank).cwiseInverse()).asDiagonal();
    const Matrix covariance = fit.root * fit.root.transpose();
    estimate.value.resize(n);
    estimate.sigma.resize(n);
    estimate.correlation = Matrix::Identity(n, n);
    for (Eigen::Index k = estimate.rank; k < n; ++k)
        estimate.ambiguities.push_back(
            fmt::format("the data cannot tell {} apart", moved_by(unknown, svd.v.col(k))));
    const Matrix lost = svd.v.rightCols(n - estimate.rank);
    for (Eigen::Index k = 0; k < n; ++k) {
        estimate.names.push_back(unknown.name(k));
        estimate.value(k) = unknown.value(k, fit.numbers(k));
        estimate.sigma(k) = lost.row(k).squaredNorm() > 1e-6
                                ? std::numeric_limits<double>::infinity()
                                : std::sqrt(covariance(k, k)) * unknown.slope(k, fit.numbers(k));
        for (Eigen::Index j = 0; j < k; ++j) {
            const double c =
                std::isinf(estimate.sigma(k)) || std::isinf(estimate.sigma(j))
                    ? std::numeric_limits<double>::quiet_NaN()
                    : covariance(k, j) / std::sqrt(covariance(k, k) * covariance(j, j));
            estimate.correlation(k, j) = estimate.correlation(j, k) = c;
            if (std::abs(c) > nearly_the_same)
                estimate.ambiguities.push_back(
                    fmt::format("{} and {} are hard to tell apart (correlation {:.4f})",
                                unknown.name(j), unknown.name(k), c));
        }
    }
}

} // namespace

UnknownStack::UnknownStack(const LayerStack& stack, const UnknownLayers& unknown) : given_(stack) {
    for (std::size_t layer = 0; layer < stack.layers.size(); ++layer) {
        const bool absorbs = !stack.layers[layer].absorption.is_zero();
        if (unknown.thickness && (absorbs || stack.layers[layer].scatters()))
            numbers_.push_back({Kind::Thickness, layer});
        if (unknown.absorption && absorbs)
            numbers_.push_back({Kind::Absorption, layer});
        if (unknown.ior)
            numbers_.push_back({Kind::Ior, layer});
    }
}

LayerStack UnknownStack::stack(const Vector& numbers) const {
    LayerStack stack = given_;
    for (Eigen::Index k = 0; k < numbers.size(); ++k) {
        const Number& number = numbers_[static_cast<std::size_t>(k)];
        Layer& layer = stack.layers[number.layer];
        switch (number.kind) {
        case Kind::Thickness:
            layer.thickness *= std::exp(numbers(k));
            break;
        case Kind::Absorption:
            layer.absorption = layer.absorption.scaled(std::exp(numbers(k)));
            break;
        case Kind::Ior:
            layer.ior += Spectrum::constant(numbers(k));
            break;
        }
    }
    return stack;
}

std::string UnknownStack::name(Eigen::Index number) const {
    const Number& which = numbers_[static_cast<std::size_t>(number)];
    const char* const kind = which.kind == Kind::Thickness    ? "thickness"
                             : which.kind == Kind::Absorption ? "absorption scale"
                                                              : "ior addend";
    return fmt::format("{} of layer {}", kind, which.layer + 1);
}

double UnknownStack::value(Eigen::Index number, double at) const {
    const Number& which = numbers_[static_cast<std::size_t>(number)];
    switch (which.kind) {
    case Kind::Thickness:
        return given_.layers[which.layer].thickness * std::exp(at);
    case Kind::Absorption:
        return std::exp(at);
    case Kind::Ior:
        break;
    }
    return at;
}

double UnknownStack::slope(Eigen::Index number, double at) const {
    const bool is_addend = numbers_[static_cast<std::size_t>(number)].kind == Kind::Ior;
    return is_addend ? 1.0 : value(number, at);
}

UnknownStackFit fit_unknown_stack(const UnknownStack& unknown, const BispectralData& data,
                                  const std::vector<Matrix>& weight) {
    if (unknown.count() == 0)
        throw_input_error({data.file.string()}, "no layer of the stack has what is unknown",
                          "absorption and thickness need a layer that absorbs");
    if (data.blocks.size() < 2)
        throw_input_error({data.file.string()},
                          "one geometry cannot tell the stack from the substrate",
                          "measure at several angles, or give the stack's numbers");
    UnknownStackFit fit;
    fit.numbers = Vector::Zero(unknown.count());
    const Disagreement disagreement(unknown, data, weight);
    ceres::NumericDiffOptions differences;
    differences.relative_step_size = 1e-5;
    auto* const cost =
        new ceres::DynamicNumericDiffCostFunction<const Disagreement, ceres::CENTRAL>(
            &disagreement, ceres::DO_NOT_TAKE_OWNERSHIP, differences);
    cost->AddParameterBlock(static_cast<int>(unknown.count()));
    cost->SetNumResiduals(disagreement.count());
    ceres::Problem problem;
    problem.AddResidualBlock(cost, nullptr, fit.numbers.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.function_tolerance = 1e-13;
    options.gradient_tolerance = 1e-13;
    options.parameter_tolerance = 1e-11;
    options.max_num_iterations = 100;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (summary.termination_type != ceres::CONVERGENCE)
        throw_runtime_error("the unknown numbers of the stack were not found: " + summary.message,
                            "start nearer to the truth or leave fewer numbers unknown");
    fit.estimate.reduced_chi_squared = 2.0 * summary.final_cost / disagreement.freedom();
    judge(jacobian_at(problem, fit.numbers.data(), unknown.count()),
          std::max(1.0, fit.estimate.reduced_chi_squared), unknown, fit);
    return fit;
}

} // namespace reradiant
