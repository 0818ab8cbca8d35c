#include "host/fit/solver/linearisation.h"

#include <ceres/cost_function.h>

#include <algorithm>
#include <utility>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Sparse = Eigen::SparseMatrix<double>;
using RowMajorSparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

void set_normal(const Eigen::Map<const RowMajorSparse>& jacobian, Sparse& normal) {
    const Sparse columns(jacobian);
    normal = columns.transpose() * columns;
}

void set_normal(const Eigen::Map<const RowMajorSparse>& jacobian, Matrix& normal) {
    normal = Matrix::Zero(jacobian.cols(), jacobian.cols());
    const double* const value = jacobian.valuePtr();
    const int* const column = jacobian.innerIndexPtr();
    for (Eigen::Index row = 0; row < jacobian.rows(); ++row)
        for (int a = jacobian.outerIndexPtr()[row]; a < jacobian.outerIndexPtr()[row + 1]; ++a)
            for (int b = a; b < jacobian.outerIndexPtr()[row + 1]; ++b)
                normal(std::max(column[a], column[b]), std::min(column[a], column[b])) +=
                    value[a] * value[b];
    normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();
}

} // namespace

Linearisation::Linearisation(const NonNegativeModel& model, const Eigen::VectorXd& start)
    : values_(start) {
    std::vector<double*> blocks;
    std::unordered_map<const double*, int> size_of;
    Eigen::Index next = 0;
    for (const int size : model.block_sizes()) {
        blocks.push_back(values_.data() + next);
        size_of[blocks.back()] = size;
        first_parameters_.push_back(next);
        problem_.AddParameterBlock(blocks.back(), size);
        next += size;
    }
    first_parameters_.push_back(next);
    model.add_residuals(problem_, blocks);
    std::vector<ceres::ResidualBlockId> ids;
    problem_.GetResidualBlocks(&ids);
    std::vector<double*> used;
    std::size_t most_numbers = 0, most_blocks = 0, most_residuals = 0;
    for (const ceres::ResidualBlockId id : ids) {
        const int count = problem_.GetCostFunctionForResidualBlock(id)->num_residuals();
        problem_.GetParameterBlocksForResidualBlock(id, &used);
        Residuals residuals{id, count, {}};
        std::size_t numbers = 0;
        for (const double* const block : used) {
            residuals.blocks.emplace_back(block - values_.data(), size_of.at(block));
            numbers += static_cast<std::size_t>(size_of.at(block));
        }
        most_numbers = std::max(most_numbers, numbers * static_cast<std::size_t>(count));
        most_blocks = std::max(most_blocks, used.size());
        most_residuals = std::max(most_residuals, static_cast<std::size_t>(count));
        residuals_.push_back(std::move(residuals));
    }
    residual_.resize(most_residuals);
    slope_.resize(most_numbers);
    slopes_.resize(most_blocks);
}

double Linearisation::cost_at(const Eigen::VectorXd& point) {
    values_ = point;
    double sum = 0.0;
    for (const Residuals& residuals : residuals_) {
        double cost = 0.0;
        if (!problem_.EvaluateResidualBlock(residuals.id, true, &cost, nullptr, nullptr))
            return std::numeric_limits<double>::infinity();
        sum += cost;
    }
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

bool Linearisation::append_rows(const Residuals& residuals, const ParameterRange& range,
                                double& cost, Eigen::VectorXd& gradient, Rows& rows) {
    double* next = slope_.data();
    for (std::size_t b = 0; b < residuals.blocks.size(); ++b) {
        const auto [first, size] = residuals.blocks[b];
        const bool is_asked = first >= range.first && first < range.first + range.count;
        slopes_[b] = is_asked ? next : nullptr;
        next += is_asked ? residuals.count * size : 0;
    }
    double mine = 0.0;
    if (!problem_.EvaluateResidualBlock(residuals.id, true, &mine, residual_.data(),
                                        slopes_.data()))
        return false;
    cost += mine;
    for (int row = 0; row < residuals.count; ++row) {
        for (std::size_t b = 0; b < residuals.blocks.size(); ++b) {
            const auto [first, size] = residuals.blocks[b];
            for (int k = 0; slopes_[b] != nullptr && k < size; ++k) {
                const double slope = slopes_[b][row * size + k];
                if (slope == 0.0)
                    continue;
                const auto column = static_cast<int>(first - range.first) + k;
                gradient(column) += slope * residual_[static_cast<std::size_t>(row)];
                rows.column.push_back(column);
                rows.value.push_back(slope);
            }
        }
        rows.begin.push_back(static_cast<int>(rows.column.size()));
    }
    return true;
}

template <typename Hessian>
std::optional<LocalModel<Hessian>> Linearisation::linearise(const Eigen::VectorXd& point,
                                                            const ParameterRange& range) {
    values_ = point;
    LocalModel<Hessian> local;
    local.gradient = Eigen::VectorXd::Zero(range.count);
    Rows rows;
    for (const Residuals& residuals : residuals_)
        if (!append_rows(residuals, range, local.cost, local.gradient, rows))
            return std::nullopt;
    if (!std::isfinite(local.cost) || !local.gradient.allFinite())
        return std::nullopt;
    set_normal(
        Eigen::Map<const RowMajorSparse>(static_cast<Eigen::Index>(rows.begin.size()) - 1,
                                         range.count, static_cast<Eigen::Index>(rows.value.size()),
                                         rows.begin.data(), rows.column.data(), rows.value.data()),
        local.normal);
    local.curvature = local.normal.diagonal();
    return local;
}

template std::optional<LocalModel<Matrix>> Linearisation::linearise(const Eigen::VectorXd&,
                                                                    const ParameterRange&);
template std::optional<LocalModel<Sparse>> Linearisation::linearise(const Eigen::VectorXd&,
                                                                    const ParameterRange&);

ParameterRange Linearisation::range_of(std::size_t first_block, std::size_t blocks) const {
    const Eigen::Index first = first_parameters_[first_block];
    return {first, first_parameters_[first_block + blocks] - first};
}

} // namespace reradiant
