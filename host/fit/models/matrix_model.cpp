#include "host/fit/models/matrix_model.h"

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// A linear residual over single numbers: sum of factor times number, less a constant.
class LinearResidual final : public ceres::CostFunction {
public:
    LinearResidual(std::vector<double> factors, double constant)
        : factors_(std::move(factors)), constant_(constant) {
        set_num_residuals(1);
        mutable_parameter_block_sizes()->assign(factors_.size(), 1);
    }
    bool Evaluate(double const* const* parameters, double* residual,
                  double** jacobians) const override {
        residual[0] = -constant_;
        for (std::size_t k = 0; k < factors_.size(); ++k) {
            residual[0] += factors_[k] * parameters[k][0];
            if (jacobians != nullptr && jacobians[k] != nullptr)
                jacobians[k][0] = factors_[k];
        }
        return true;
    }

private:
    std::vector<double> factors_;
    double constant_;
};

/// Penalty of one excitation column, over its entries.
class EntryColumnPenalty final : public ceres::CostFunction {
public:
    EntryColumnPenalty(std::vector<double> photons, Eigen::Index column,
                       const PhotonPenalty& penalty)
        : photons_(std::move(photons)), column_(column), penalty_(penalty) {
        set_num_residuals(PhotonPenalty::residuals_of_a_column);
        mutable_parameter_block_sizes()->assign(photons_.size(), 1);
    }
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
        double sum = 0.0;
        for (std::size_t k = 0; k < photons_.size(); ++k)
            sum += photons_[k] * parameters[k][0];
        const auto at = penalty_.residuals(column_, sum);
        std::copy(at.begin(), at.end(), residuals);
        const auto slopes = penalty_.slopes(column_, sum);
        for (std::size_t k = 0; jacobians != nullptr && k < photons_.size(); ++k)
            for (std::size_t r = 0; jacobians[k] != nullptr && r < slopes.size(); ++r)
                jacobians[k][r] = slopes[r] * photons_[k];
        return true;
    }

private:
    std::vector<double> photons_;
    Eigen::Index column_;
    const PhotonPenalty& penalty_;
};

} // namespace

MatrixModel::MatrixModel(const FitTarget& target, const Smoothness& smoothness,
                         const PhotonPenalty& penalty, RobustLoss loss)
    : target_(target), penalty_(penalty), loss_(loss) {
    const Eigen::Index rows = target.value.rows(), columns = target.value.cols();
    index_.setConstant(rows, columns, -1);
    for (Eigen::Index i = 0; i < columns; ++i)
        for (Eigen::Index o = 0; o < rows; ++o)
            if (target.allowed(o, i) > 0.0)
                index_(o, i) = count_++;
    const auto add = [&](Eigen::Index o, Eigen::Index i, Eigen::Index down, Eigen::Index right,
                         double precision) {
        if (o + 2 * down >= rows || i + 2 * right >= columns)
            return;
        const std::vector<Eigen::Index> at = {index_(o, i), index_(o + down, i + right),
                                              index_(o + 2 * down, i + 2 * right)};
        const double factor = std::sqrt(precision);
        if (at[0] >= 0 && at[1] >= 0 && at[2] >= 0)
            rows_.push_back({at, {factor, -2.0 * factor, factor}});
    };
    for (Eigen::Index i = 0; i < columns; ++i)
        for (Eigen::Index o = 0; o < rows; ++o) {
            add(o, i, 1, 0, smoothness.emission);
            add(o, i, 0, 1, smoothness.excitation);
        }
    for (Eigen::Index k = 0; k < count_; ++k)
        rows_.push_back({{k}, {std::sqrt(smoothness.entry)}});
}

std::vector<int> MatrixModel::block_sizes() const {
    return std::vector<int>(static_cast<std::size_t>(count_), 1);
}

void MatrixModel::add_residuals(ceres::Problem& problem, const std::vector<double*>& blocks) const {
    ceres::LossFunction* const loss = make_loss(loss_);
    for (Eigen::Index i = 0; i < target_.value.cols(); ++i) {
        std::vector<double*> column;
        std::vector<double> photons;
        for (Eigen::Index o = 0; o < target_.value.rows(); ++o) {
            if (index_(o, i) < 0)
                continue;
            double* const block = blocks[static_cast<std::size_t>(index_(o, i))];
            const double weight = target_.weight(o, i);
            if (weight > 0.0)
                problem.AddResidualBlock(new LinearResidual({weight}, weight * target_.value(o, i)),
                                         loss, block);
            column.push_back(block);
            photons.push_back(target_.photons(o, i));
        }
        if (penalty_.watches(i) && !column.empty())
            problem.AddResidualBlock(new EntryColumnPenalty(photons, i, penalty_), nullptr, column);
    }
    for (const SmoothnessRow& row : rows_) {
        std::vector<double*> used;
        for (const Eigen::Index parameter : row.parameters)
            used.push_back(blocks[static_cast<std::size_t>(parameter)]);
        problem.AddResidualBlock(new LinearResidual(row.factors, 0.0), nullptr, used);
    }
}

Matrix MatrixModel::matrix(const Vector& parameters) const {
    Matrix result = Matrix::Zero(index_.rows(), index_.cols());
    for (Eigen::Index k = 0; k < index_.size(); ++k)
        if (index_(k) >= 0)
            result(k) = parameters(index_(k));
    return result;
}

Vector MatrixModel::gathered(const Matrix& entries) const {
    Vector list(count_);
    for (Eigen::Index k = 0; k < index_.size(); ++k)
        if (index_(k) >= 0)
            list(index_(k)) = entries(k);
    return list;
}

Eigen::SparseMatrix<double> MatrixModel::prior() const {
    std::vector<Eigen::Triplet<double>> entries;
    for (const SmoothnessRow& row : rows_)
        for (std::size_t a = 0; a < row.parameters.size(); ++a)
            for (std::size_t b = 0; b < row.parameters.size(); ++b)
                entries.emplace_back(static_cast<int>(row.parameters[a]),
                                     static_cast<int>(row.parameters[b]),
                                     row.factors[a] * row.factors[b]);
    Eigen::SparseMatrix<double> precision(count_, count_);
    precision.setFromTriplets(entries.begin(), entries.end());
    return precision;
}

} // namespace reradiant
