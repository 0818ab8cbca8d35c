#include "host/fit/dye/dye_model.h"

#include "host/fit/factors/factor_start.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// Weight of an emission's unit, which changes nothing that is seen.
constexpr double unit_weight = 1e4;
/// Standard deviations of the prior.
constexpr double deepest = 10.0, brightest = 0.3;
/// Least yield that the scale is divided by.
constexpr double least_yield = 1e-3;

/// Hands the model to Ceres.
class DyeCost final : public ceres::CostFunction {
public:
    explicit DyeCost(const DyeModel& model) : model_(model) {
        set_num_residuals(static_cast<int>(model.residuals()));
        for (const int size : model.block_sizes())
            mutable_parameter_block_sizes()->push_back(size);
    }

    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
        Vector packed(model_.size()), values;
        Index next = 0;
        for (std::size_t block = 0; block < parameter_block_sizes().size(); ++block) {
            const int size = parameter_block_sizes()[block];
            packed.segment(next, size) = Eigen::Map<const Vector>(parameters[block], size);
            next += size;
        }
        if (!model_.is_within_tables(packed))
            return false;
        Matrix slopes;
        model_.evaluate(packed, values, jacobians != nullptr ? &slopes : nullptr);
        Eigen::Map<Vector>(residuals, values.size()) = values;
        next = 0;
        for (std::size_t block = 0; block < parameter_block_sizes().size(); ++block) {
            const int size = parameter_block_sizes()[block];
            if (jacobians != nullptr && jacobians[block] != nullptr)
                Eigen::Map<Matrix>(jacobians[block], size, values.size()) =
                    slopes.middleCols(next, size).transpose();
            next += size;
        }
        return values.allFinite();
    }

private:
    const DyeModel& model_;
};

} // namespace

Index DyeProblem::used_count() const {
    Index count = 0;
    for (const DyeSampleData& sample : samples)
        count += sample.data->used_count();
    return count;
}

double DyeProblem::largest_factor() const {
    double largest = 0.0;
    for (const DyeSampleData& sample : samples)
        largest = std::max(largest, sample.depth_factor);
    return largest;
}

double DyeProblem::largest_absorption() const {
    double largest = std::numeric_limits<double>::infinity();
    for (const DyeSampleData& sample : samples)
        largest = std::min(largest, sample.stack->largest_depth() / sample.depth_factor);
    return largest;
}

DyeModel::DyeModel(const DyeProblem& problem, SmoothBasis absorption, SmoothBasis emission,
                   int dyes)
    : problem_(&problem), absorption_(std::move(absorption)), emission_(std::move(emission)),
      dyes_(dyes), held_(static_cast<std::size_t>(size()), false),
      unit_(Matrix::Ones(problem.bands.count, dyes)), unit_sum_(Vector::Ones(dyes)) {}

void DyeModel::keep_unit(const Matrix& emission) {
    for (Index dye = 0; dye < dyes_; ++dye) {
        Index peak = 0;
        emission.col(dye).maxCoeff(&peak);
        unit_.col(dye).head(peak).setZero();
        unit_.col(dye).tail(unit_.rows() - peak).setOnes();
        unit_sum_(dye) = emission.col(dye).dot(unit_.col(dye));
    }
}

DyeModel::Places DyeModel::places() const {
    Places places{0, dyes_ * absorption_.size(), 0, 0, 0};
    places.quantum_yield = places.emission + dyes_ * emission_.size();
    places.scale = places.quantum_yield + dyes_;
    places.reflectance = places.scale + (problem_->fits_scale ? 1 : 0);
    return places;
}

Index DyeModel::size() const {
    return places().reflectance + (problem_->fits_substrate ? problem_->bands.count : 0);
}

std::vector<int> DyeModel::block_sizes() const {
    const Places at = places();
    std::vector<int> sizes;
    for (const Index size :
         {at.emission, at.quantum_yield - at.emission, at.scale - at.quantum_yield,
          at.reflectance - at.scale, this->size() - at.reflectance})
        if (size > 0)
            sizes.push_back(static_cast<int>(size));
    return sizes;
}

void DyeModel::add_residuals(ceres::Problem& problem, const std::vector<double*>& blocks) const {
    problem.AddResidualBlock(new DyeCost(*this), nullptr, blocks);
}

DyeParameters DyeModel::parameters(const Vector& packed) const {
    const Places at = places();
    const auto reshaped = [&](Index first, Index rows) {
        return packed.segment(first, rows * dyes_).reshaped(rows, dyes_);
    };
    DyeParameters parameters;
    parameters.absorption = absorption_.values * reshaped(0, absorption_.size());
    parameters.emission = Matrix::Zero(problem_->bands.count, dyes_);
    parameters.emission.middleRows(problem_->emission.first, problem_->emission.count) =
        emission_.values * reshaped(at.emission, emission_.size());
    parameters.quantum_yield = packed.segment(at.quantum_yield, dyes_);
    if (problem_->fits_scale)
        parameters.scale = packed(at.scale);
    if (problem_->fits_substrate)
        parameters.reflectance = packed.tail(problem_->bands.count);
    return parameters;
}

Vector DyeModel::packed(const DyeParameters& parameters) const {
    const Places at = places();
    Vector packed = Vector::Zero(size());
    packed.head(at.emission) = coefficients_near(absorption_, parameters.absorption).reshaped();
    packed.segment(at.emission, at.quantum_yield - at.emission) =
        coefficients_near(emission_, parameters.emission.middleRows(problem_->emission.first,
                                                                    problem_->emission.count))
            .reshaped();
    packed.segment(at.quantum_yield, dyes_) = parameters.quantum_yield;
    if (problem_->fits_scale)
        packed(at.scale) = parameters.scale;
    if (problem_->fits_substrate)
        packed.tail(problem_->bands.count) = parameters.reflectance;
    return packed;
}

DyeValues DyeModel::values(const DyeParameters& parameters, const DyeSampleData& sample) const {
    DyeValues values;
    values.depth = sample.depth_factor * parameters.absorption;
    values.quantum_yield = parameters.quantum_yield;
    values.reflectance_added = parameters.reflectance;
    for (Index dye = 0; dye < dyes_; ++dye)
        values.shares.emplace_back(parameters.emission.col(dye), problem_->bands);
    return values;
}

double DyeModel::gain(const DyeParameters& parameters) const {
    return problem_->fits_scale
               ? parameters.scale / std::max(parameters.quantum_yield(0), least_yield)
               : 1.0;
}

std::vector<std::vector<Matrix>> DyeModel::images(const Vector& packed) const {
    const DyeParameters at = parameters(packed);
    std::vector<std::vector<Matrix>> all;
    for (const DyeSampleData& sample : problem_->samples) {
        all.emplace_back();
        for (const DyeImage& image : dye_images(*sample.stack, values(at, sample),
                                                problem_->emission, problem_->excitation, false))
            all.back().push_back(gain(at) * image.value * problem_->lamp.asDiagonal());
    }
    return all;
}

/// Derivatives by the packed parameters, without the lamp.
Matrix DyeModel::chained(const DyeImage& image, const DyeParameters& parameters,
                         double depth_factor) const {
    const Places at = places();
    const Index bands = problem_->bands.count;
    const double gain = this->gain(parameters);
    Matrix slopes = Matrix::Zero(image.value.size(), size());
    for (Index dye = 0; dye < dyes_; ++dye) {
        slopes.middleCols(dye * absorption_.size(), absorption_.size()) =
            gain * depth_factor * image.by_depth.middleCols(dye * bands, bands) *
            absorption_.values;
        slopes.middleCols(at.emission + dye * emission_.size(), emission_.size()) =
            gain *
            image.by_emission.middleCols(dye * bands + problem_->emission.first,
                                         problem_->emission.count) *
            emission_.values;
    }
    slopes.middleCols(at.quantum_yield, dyes_) = gain * image.by_yield;
    if (problem_->fits_scale) {
        const double yield = std::max(parameters.quantum_yield(0), least_yield);
        slopes.col(at.scale) = image.value.reshaped() / yield;
        if (parameters.quantum_yield(0) > least_yield)
            slopes.col(at.quantum_yield) -= gain / yield * image.value.reshaped();
    }
    if (problem_->fits_substrate)
        slopes.rightCols(bands) = gain * image.by_reflectance;
    return slopes;
}

void DyeModel::evaluate(const Vector& packed, Vector& residual, Matrix* jacobian) const {
    const DyeParameters at = parameters(packed);
    residual.resize(residuals());
    if (jacobian != nullptr)
        jacobian->setZero(residual.size(), packed.size());
    Index next = 0;
    for (const DyeSampleData& sample : problem_->samples) {
        const auto images = dye_images(*sample.stack, values(at, sample), problem_->emission,
                                       problem_->excitation, jacobian != nullptr);
        for (std::size_t view = 0; view < images.size(); ++view) {
            const DyeBlock& block = sample.data->blocks[view];
            const Matrix slopes =
                jacobian != nullptr ? chained(images[view], at, sample.depth_factor) : Matrix();
            for (Index k = 0; k < block.weight.size(); ++k) {
                if (!(block.weight(k) > 0.0))
                    continue;
                const double lamp = problem_->lamp(k / block.weight.rows());
                residual(next) =
                    block.weight(k) * (gain(at) * lamp * images[view].value(k) - block.value(k));
                if (jacobian != nullptr)
                    jacobian->row(next) = block.weight(k) * lamp * slopes.row(k);
                ++next;
            }
        }
    }
    for (Index dye = 0; dye < dyes_; ++dye, ++next) {
        residual(next) = unit_weight * (at.emission.col(dye).dot(unit_.col(dye)) - unit_sum_(dye));
        if (jacobian != nullptr)
            jacobian->row(next).segment(places().emission + dye * emission_.size(),
                                        emission_.size()) =
                unit_weight *
                unit_.col(dye)
                    .segment(problem_->emission.first, problem_->emission.count)
                    .transpose() *
                emission_.values;
    }
    for (Index k = 0; k < priors(); ++k, ++next) {
        residual(next) = prior_weight(k) * packed(k);
        if (jacobian != nullptr)
            (*jacobian)(next, k) = prior_weight(k);
    }
    for (std::size_t k = 0; jacobian != nullptr && k < held_.size(); ++k)
        if (held_[k])
            jacobian->col(static_cast<Index>(k)).setZero();
}

double DyeModel::prior_weight(Index parameter) const {
    return parameter < places().emission ? problem_->largest_factor() / deepest : 1.0 / brightest;
}

bool DyeModel::is_within_tables(const Vector& packed) const {
    return parameters(packed).absorption.rowwise().sum().maxCoeff() <=
           problem_->largest_absorption();
}

double DyeModel::chi_squared(const Vector& packed) const {
    Vector residual;
    evaluate(packed, residual, nullptr);
    return residual.head(problem_->used_count()).squaredNorm();
}

} // namespace reradiant
