#include "host/fit/factors/factor_model.h"

#include "host/fit/factors/knot_choice.h"
#include "reradiant/fit.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Basis functions that are not zero at a band.
struct Support {
    Eigen::Index first = 0;
    std::vector<double> values;
};

Support support_at(const SmoothBasis& basis, Eigen::Index band) {
    Eigen::Index first = 0, end = basis.size();
    while (first < end && basis.values(band, first) == 0.0)
        ++first;
    while (end > first && basis.values(band, end - 1) == 0.0)
        --end;
    Support support{first, {}};
    for (Eigen::Index j = first; j < end; ++j)
        support.values.push_back(basis.values(band, j));
    return support;
}

/// A number a term, without memory of its own: residuals are evaluated millions of times.
using TermVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, largest_factor_rank, 1>;

/// Sum over a support of value times block, K numbers.
template <typename Block>
TermVector curve_values(const Support& support, int rank, Block block) {
    TermVector sum = TermVector::Zero(rank);
    for (std::size_t a = 0; a < support.values.size(); ++a)
        sum += support.values[a] * Eigen::Map<const TermVector>(block(a), rank);
    return sum;
}

/// weight * (sum_k e_k(o) x_k(i) - value): blocks of the emission's support, then of the
/// excitation's.
class EntryResidual final : public ceres::CostFunction {
public:
    EntryResidual(int rank, Support emission, Support excitation, double value, double weight)
        : rank_(rank), emission_(std::move(emission)), excitation_(std::move(excitation)),
          value_(value), weight_(weight) {
        set_num_residuals(1);
        for (std::size_t b = 0; b < emission_.values.size() + excitation_.values.size(); ++b)
            mutable_parameter_block_sizes()->push_back(rank);
    }

    bool Evaluate(double const* const* parameters, double* residual,
                  double** jacobians) const override {
        const std::size_t split = emission_.values.size();
        const TermVector e =
            curve_values(emission_, rank_, [&](std::size_t a) { return parameters[a]; });
        const TermVector x =
            curve_values(excitation_, rank_, [&](std::size_t b) { return parameters[split + b]; });
        residual[0] = weight_ * (e.dot(x) - value_);
        if (jacobians == nullptr)
            return true;
        for (std::size_t a = 0; a < split; ++a)
            if (jacobians[a] != nullptr)
                Eigen::Map<TermVector>(jacobians[a], rank_) = weight_ * emission_.values[a] * x;
        for (std::size_t b = 0; b < excitation_.values.size(); ++b)
            if (jacobians[split + b] != nullptr)
                Eigen::Map<TermVector>(jacobians[split + b], rank_) =
                    weight_ * excitation_.values[b] * e;
        return true;
    }

private:
    int rank_;
    Support emission_, excitation_;
    double value_, weight_;
};

/// Penalty of one excitation column: all emission blocks, then those of its excitation support.
class ColumnPenalty final : public ceres::CostFunction {
public:
    ColumnPenalty(int rank, const SmoothBasis& emission, Support excitation, Vector photons,
                  Eigen::Index column, const PhotonPenalty& penalty)
        : rank_(rank), excitation_(std::move(excitation)),
          share_(emission.values.transpose() * photons), column_(column), penalty_(penalty) {
        set_num_residuals(PhotonPenalty::residuals_of_a_column);
        for (Eigen::Index b = 0; b < share_.size(); ++b)
            mutable_parameter_block_sizes()->push_back(rank);
        for (std::size_t b = 0; b < excitation_.values.size(); ++b)
            mutable_parameter_block_sizes()->push_back(rank);
    }

    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
        const auto split = static_cast<std::size_t>(share_.size());
        TermVector e = TermVector::Zero(rank_);
        for (std::size_t a = 0; a < split; ++a)
            e += share_(static_cast<Eigen::Index>(a)) *
                 Eigen::Map<const Vector>(parameters[a], rank_);
        const TermVector x =
            curve_values(excitation_, rank_, [&](std::size_t b) { return parameters[split + b]; });
        const auto at = penalty_.residuals(column_, e.dot(x));
        std::copy(at.begin(), at.end(), residuals);
        if (jacobians == nullptr)
            return true;
        const auto slopes = penalty_.slopes(column_, e.dot(x));
        const Eigen::Map<const Eigen::Vector2d> slope(slopes.data());
        for (std::size_t a = 0; a < split; ++a)
            if (jacobians[a] != nullptr)
                Eigen::Map<RowMajor>(jacobians[a], slope.size(), rank_) =
                    slope * share_(static_cast<Eigen::Index>(a)) * x.transpose();
        for (std::size_t b = 0; b < excitation_.values.size(); ++b)
            if (jacobians[split + b] != nullptr)
                Eigen::Map<RowMajor>(jacobians[split + b], slope.size(), rank_) =
                    slope * excitation_.values[b] * e.transpose();
        return true;
    }

private:
    int rank_;
    Support excitation_;
    Vector share_; ///< photons of column i that a unit of every emission coefficient stands for
    Eigen::Index column_;
    const PhotonPenalty& penalty_;
};

/// Width of the prior of a coefficient. Where data determine a coefficient, its values are about 1
/// (the data's peak is 1 and both curves of a term are equally long). Where they do not, in columns
/// that hold next to nothing that the term emits, a prior of this width keeps it from growing
/// without bound. In all it adds about 2 to the chi squared.
constexpr double prior_width = 10.0;
/// Prior of the second differences of a curve that holds lines of one band, on any grid.
constexpr double bend_of_a_line = 2.0;
/// Weights of three successive values in their second difference.
constexpr std::array bend_weights = {1.0, -2.0, 1.0};

/// coefficient / prior_width for the K coefficients of a block.
class CoefficientPrior final : public ceres::CostFunction {
public:
    explicit CoefficientPrior(int rank) : rank_(rank) {
        set_num_residuals(rank);
        mutable_parameter_block_sizes()->push_back(rank);
    }
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
        Eigen::Map<Vector>(residuals, rank_) =
            Eigen::Map<const Vector>(parameters[0], rank_) / prior_width;
        if (jacobians != nullptr && jacobians[0] != nullptr)
            Eigen::Map<Matrix>(jacobians[0], rank_, rank_) =
                Matrix::Identity(rank_, rank_) / prior_width;
        return true;
    }

private:
    int rank_;
};

/// (a - 2 b + c) / width for the K coefficients of three neighbouring blocks.
class BendPrior final : public ceres::CostFunction {
public:
    BendPrior(int rank, double width) : rank_(rank), width_(width) {
        set_num_residuals(rank);
        mutable_parameter_block_sizes()->assign(bend_weights.size(), rank);
    }
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
        Eigen::Map<Vector> bend(residuals, rank_);
        bend.setZero();
        for (std::size_t b = 0; b < bend_weights.size(); ++b) {
            const double weight = bend_weights[b] / width_;
            bend += weight * Eigen::Map<const Vector>(parameters[b], rank_);
            if (jacobians != nullptr && jacobians[b] != nullptr)
                Eigen::Map<Matrix>(jacobians[b], rank_, rank_) =
                    weight * Matrix::Identity(rank_, rank_);
        }
        return true;
    }

private:
    int rank_;
    double width_;
};

} // namespace

FactorModel::FactorModel(const FitTarget& target, int rank, const SmoothBasis& emission,
                         const SmoothBasis& excitation, const PhotonPenalty& penalty,
                         RobustLoss loss, double bend_width)
    : target_(target), rank_(rank), emission_(emission), excitation_(excitation), penalty_(penalty),
      loss_(loss), bend_width_(bend_width) {}

std::optional<double> FactorModel::bend_width(const SmoothBasis& basis,
                                              const WavelengthGrid& grid) const {
    if (!basis.knots.empty())
        return std::nullopt;
    const double spacing_nm = basis.is_per_band() ? grid.step_nm : basis.spacing_nm;
    return std::min(bend_of_a_line, bend_width_ * std::pow(spacing_nm / bend_step_nm, 2));
}

std::vector<int> FactorModel::block_sizes() const {
    return std::vector<int>(static_cast<std::size_t>(emission_.size() + excitation_.size()), rank_);
}

void FactorModel::add_residuals(ceres::Problem& problem, const std::vector<double*>& blocks) const {
    const auto first_excitation = static_cast<std::size_t>(emission_.size());
    const auto append = [&](std::vector<double*>& list, const Support& support, std::size_t first) {
        for (std::size_t a = 0; a < support.values.size(); ++a)
            list.push_back(blocks[first + static_cast<std::size_t>(support.first) + a]);
    };
    for (double* const block : blocks)
        problem.AddResidualBlock(new CoefficientPrior(rank_), nullptr, block);
    std::size_t first = 0;
    for (const auto& [basis, grid] : bases()) {
        const auto end = first + static_cast<std::size_t>(basis.size());
        if (const auto width = bend_width(basis, grid))
            for (std::size_t b = first; b + 2 < end; ++b)
                problem.AddResidualBlock(new BendPrior(rank_, *width), nullptr, blocks[b],
                                         blocks[b + 1], blocks[b + 2]);
        first = end;
    }
    ceres::LossFunction* const loss = make_loss(loss_);
    for (Eigen::Index i = 0; i < target_.value.cols(); ++i) {
        const Support x = support_at(excitation_, i);
        for (Eigen::Index o = 0; o < target_.value.rows(); ++o) {
            if (target_.weight(o, i) <= 0.0 || target_.allowed(o, i) == 0.0)
                continue;
            const Support e = support_at(emission_, o);
            std::vector<double*> used;
            append(used, e, 0);
            append(used, x, first_excitation);
            problem.AddResidualBlock(
                new EntryResidual(rank_, e, x, target_.value(o, i), target_.weight(o, i)), loss,
                used);
        }
        if (penalty_.watches(i)) {
            std::vector<double*> used(blocks.begin(), blocks.begin() + emission_.size());
            append(used, x, first_excitation);
            const Vector photons = target_.photons.col(i).cwiseProduct(target_.allowed.col(i));
            problem.AddResidualBlock(new ColumnPenalty(rank_, emission_, x, photons, i, penalty_),
                                     nullptr, used);
        }
    }
}

Matrix FactorModel::prior_jacobian() const {
    const Eigen::Index functions = emission_.size() + excitation_.size(), count = functions * rank_;
    Matrix prior = Matrix::Zero(2 * count, count);
    prior.diagonal().setConstant(1.0 / prior_width);
    Eigen::Index first = 0;
    for (const auto& [basis, grid] : bases()) {
        const Eigen::Index end = first + basis.size() * rank_;
        if (const auto width = bend_width(basis, grid))
            for (Eigen::Index k = first; k + 2 * rank_ < end; ++k)
                for (std::size_t b = 0; b < bend_weights.size(); ++b)
                    prior(count + k, k + static_cast<Eigen::Index>(b) * rank_) =
                        bend_weights[b] / *width;
        first = end;
    }
    return prior;
}

std::size_t FactorModel::stored_numbers() const {
    const std::size_t positions =
        emission_.knots.empty() && excitation_.knots.empty() ? 0 : numbers_of_positions(target_);
    return static_cast<std::size_t>(rank_ * (emission_.size() + excitation_.size())) + positions;
}

Matrix FactorModel::emission_coefficients(const Vector& parameters) const {
    return Eigen::Map<const RowMajor>(parameters.data(), emission_.size(), rank_);
}

Matrix FactorModel::excitation_coefficients(const Vector& parameters) const {
    return Eigen::Map<const RowMajor>(parameters.data() + emission_.size() * rank_,
                                      excitation_.size(), rank_);
}

FactorCurves FactorModel::curves(const Vector& parameters) const {
    return {emission_.values * emission_coefficients(parameters),
            excitation_.values * excitation_coefficients(parameters)};
}

Matrix FactorModel::matrix(const Vector& parameters) const {
    const FactorCurves both = curves(parameters);
    return (both.emission * both.excitation.transpose()).cwiseProduct(target_.allowed);
}

Matrix FactorModel::entry_jacobian(const Vector& parameters) const {
    const FactorCurves both = curves(parameters);
    const Eigen::Index rows = target_.value.rows(), split = emission_.size() * rank_;
    Matrix jacobian = Matrix::Zero(target_.value.size(), parameters.size());
    for (Eigen::Index i = 0; i < target_.value.cols(); ++i)
        for (Eigen::Index o = 0; o < rows; ++o) {
            if (target_.allowed(o, i) == 0.0)
                continue;
            auto row = jacobian.row(o + i * rows);
            for (Eigen::Index a = 0; a < emission_.size(); ++a)
                if (emission_.values(o, a) != 0.0)
                    row.segment(a * rank_, rank_) = emission_.values(o, a) * both.excitation.row(i);
            for (Eigen::Index b = 0; b < excitation_.size(); ++b)
                if (excitation_.values(i, b) != 0.0)
                    row.segment(split + b * rank_, rank_) =
                        excitation_.values(i, b) * both.emission.row(o);
        }
    return jacobian;
}

Vector FactorModel::parameters(const Matrix& emission_coefficients,
                               const Matrix& excitation_coefficients) const {
    Vector result((emission_.size() + excitation_.size()) * rank_);
    Eigen::Map<RowMajor>(result.data(), emission_.size(), rank_) = emission_coefficients;
    Eigen::Map<RowMajor>(result.data() + emission_.size() * rank_, excitation_.size(), rank_) =
        excitation_coefficients;
    return result;
}

void FactorModel::balance(Vector& parameters) const {
    Matrix e = emission_coefficients(parameters), x = excitation_coefficients(parameters);
    for (int k = 0; k < rank_; ++k) {
        const double e_norm = e.col(k).norm(), x_norm = x.col(k).norm();
        if (e_norm <= 0.0 || x_norm <= 0.0)
            continue;
        e.col(k) *= std::sqrt(x_norm / e_norm);
        x.col(k) *= std::sqrt(e_norm / x_norm);
    }
    parameters = this->parameters(e, x);
}

} // namespace reradiant
