#include "host/fit/models/gaussian_model.h"

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Slopes = std::array<double, 5>;

constexpr double usual_width = 0.1; ///< 1/um: 30 nm at 550 nm
constexpr double prior_of_log_width = 1.5, prior_of_centre = 1.0;

double wavenumber(double nm) {
    return 1e3 / nm;
}

/// Value of one Gaussian at a pair of wavenumbers; derivatives where asked for.
double gaussian(const double* p, double emission, double excitation, double* slopes) {
    const double e_width = std::exp(p[2]), x_width = std::exp(p[4]);
    const double e = (emission - p[1]) / e_width, x = (excitation - p[3]) / x_width;
    const double shape = std::exp(-0.5 * (e * e + x * x));
    if (slopes != nullptr) {
        slopes[0] = shape;
        slopes[1] = p[0] * shape * e / e_width;
        slopes[2] = p[0] * shape * e * e;
        slopes[3] = p[0] * shape * x / x_width;
        slopes[4] = p[0] * shape * x * x;
    }
    return p[0] * shape;
}

/// weight * (sum of Gaussians - value) of one entry.
class GaussianResidual final : public ceres::CostFunction {
public:
    GaussianResidual(int count, double emission, double excitation, double value, double weight)
        : emission_(emission), excitation_(excitation), value_(value), weight_(weight) {
        set_num_residuals(1);
        mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(count), 5);
    }
    bool Evaluate(double const* const* parameters, double* residual,
                  double** jacobians) const override {
        double sum = 0.0;
        for (std::size_t k = 0; k < parameter_block_sizes().size(); ++k) {
            double* const slopes = jacobians == nullptr ? nullptr : jacobians[k];
            sum += gaussian(parameters[k], emission_, excitation_, slopes);
            for (int j = 0; slopes != nullptr && j < 5; ++j)
                slopes[j] *= weight_;
        }
        residual[0] = weight_ * (sum - value_);
        return std::isfinite(residual[0]);
    }

private:
    double emission_, excitation_, value_, weight_;
};

/// Penalty of one excitation column.
class GaussianColumnPenalty final : public ceres::CostFunction {
public:
    GaussianColumnPenalty(int count, const FitTarget& target, Eigen::Index column,
                          const PhotonPenalty& penalty)
        : target_(target), column_(column), penalty_(penalty) {
        set_num_residuals(PhotonPenalty::residuals_of_a_column);
        mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(count), 5);
    }
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
        const std::size_t count = parameter_block_sizes().size();
        std::vector<Slopes> slopes(count, Slopes{});
        double sum = 0.0;
        const double x = wavenumber(target_.excitation.centre_nm(static_cast<int>(column_)));
        for (int o = 0; o < target_.emission.count; ++o) {
            const double photons = target_.photons(o, column_) * target_.allowed(o, column_);
            for (std::size_t k = 0; photons > 0.0 && k < count; ++k) {
                Slopes one{};
                sum += photons * gaussian(parameters[k], wavenumber(target_.emission.centre_nm(o)),
                                          x, one.data());
                for (std::size_t j = 0; j < 5; ++j)
                    slopes[k][j] += photons * one[j];
            }
        }
        const auto at = penalty_.residuals(column_, sum);
        std::copy(at.begin(), at.end(), residuals);
        const auto by_sum = penalty_.slopes(column_, sum);
        for (std::size_t k = 0; jacobians != nullptr && k < count; ++k)
            for (std::size_t j = 0; jacobians[k] != nullptr && j < 5; ++j)
                for (std::size_t r = 0; r < by_sum.size(); ++r)
                    jacobians[k][5 * r + j] = by_sum[r] * slopes[k][j];
        return std::isfinite(sum);
    }

private:
    const FitTarget& target_;
    Eigen::Index column_;
    const PhotonPenalty& penalty_;
};

/// The weak prior of one Gaussian.
class GaussianPrior final : public ceres::CostFunction {
public:
    GaussianPrior(double emission, double excitation)
        : emission_(emission), excitation_(excitation) {
        set_num_residuals(4);
        mutable_parameter_block_sizes()->assign(1, 5);
    }
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
        const double* const p = parameters[0];
        const std::array<double, 4> middle{emission_, std::log(usual_width), excitation_,
                                           std::log(usual_width)};
        const std::array<double, 4> spread{prior_of_centre, prior_of_log_width, prior_of_centre,
                                           prior_of_log_width};
        for (std::size_t j = 0; j < 4; ++j)
            residuals[j] = (p[j + 1] - middle[j]) / spread[j];
        if (jacobians == nullptr || jacobians[0] == nullptr)
            return true;
        std::fill(jacobians[0], jacobians[0] + 20, 0.0);
        for (std::size_t j = 0; j < 4; ++j)
            jacobians[0][5 * j + j + 1] = 1.0 / spread[j];
        return true;
    }

private:
    double emission_, excitation_;
};

double middle_of(const WavelengthGrid& grid) {
    return 0.5 * (wavenumber(grid.from_nm) + wavenumber(grid.to_nm()));
}

/// Mean over each entry and its neighbours that are within the matrix.
Matrix smoothed(const Matrix& values) {
    Matrix result = values;
    for (Eigen::Index i = 0; i < values.cols(); ++i)
        for (Eigen::Index o = 0; o < values.rows(); ++o) {
            const Eigen::Index first_o = std::max<Eigen::Index>(0, o - 1),
                               first_i = std::max<Eigen::Index>(0, i - 1);
            result(o, i) = values
                               .block(first_o, first_i, std::min(values.rows(), o + 2) - first_o,
                                      std::min(values.cols(), i + 2) - first_i)
                               .mean();
        }
    return result;
}

} // namespace

GaussianModel::GaussianModel(const FitTarget& target, int count, const PhotonPenalty& penalty,
                             RobustLoss loss)
    : target_(target), count_(count), penalty_(penalty), loss_(loss) {}

std::vector<int> GaussianModel::block_sizes() const {
    return std::vector<int>(static_cast<std::size_t>(count_), 5);
}

void GaussianModel::add_residuals(ceres::Problem& problem,
                                  const std::vector<double*>& blocks) const {
    ceres::LossFunction* const loss = make_loss(loss_);
    for (int i = 0; i < target_.excitation.count; ++i) {
        for (int o = 0; o < target_.emission.count; ++o)
            if (target_.weight(o, i) > 0.0)
                problem.AddResidualBlock(
                    new GaussianResidual(count_, wavenumber(target_.emission.centre_nm(o)),
                                         wavenumber(target_.excitation.centre_nm(i)),
                                         target_.value(o, i), target_.weight(o, i)),
                    loss, blocks);
        if (penalty_.watches(i))
            problem.AddResidualBlock(new GaussianColumnPenalty(count_, target_, i, penalty_),
                                     nullptr, blocks);
    }
    for (double* block : blocks)
        problem.AddResidualBlock(
            new GaussianPrior(middle_of(target_.emission), middle_of(target_.excitation)), nullptr,
            block);
}

FactorCurves GaussianModel::curves(const Vector& parameters) const {
    FactorCurves curves{Matrix(target_.emission.count, count_),
                        Matrix(target_.excitation.count, count_)};
    for (int k = 0; k < count_; ++k) {
        const double* const p = parameters.data() + 5 * k;
        for (int o = 0; o < target_.emission.count; ++o)
            curves.emission(o, k) =
                gaussian(p, wavenumber(target_.emission.centre_nm(o)), p[3], nullptr);
        const double one_x[] = {1.0, p[1], p[2], p[3], p[4]};
        for (int i = 0; i < target_.excitation.count; ++i)
            curves.excitation(i, k) =
                gaussian(one_x, p[1], wavenumber(target_.excitation.centre_nm(i)), nullptr);
    }
    return curves;
}

Matrix GaussianModel::matrix(const Vector& parameters) const {
    const FactorCurves both = curves(parameters);
    return (both.emission * both.excitation.transpose()).cwiseProduct(target_.allowed);
}

Matrix GaussianModel::entry_jacobian(const Vector& parameters) const {
    Matrix jacobian = Matrix::Zero(target_.value.size(), parameters.size());
    for (int i = 0; i < target_.excitation.count; ++i)
        for (int o = 0; o < target_.emission.count; ++o)
            for (int k = 0; target_.allowed(o, i) > 0.0 && k < count_; ++k) {
                Slopes slopes{};
                gaussian(parameters.data() + 5 * k, wavenumber(target_.emission.centre_nm(o)),
                         wavenumber(target_.excitation.centre_nm(i)), slopes.data());
                jacobian.row(o + static_cast<Eigen::Index>(i) * target_.emission.count)
                    .segment<5>(5 * k) = Eigen::Map<const Eigen::RowVectorXd>(slopes.data(), 5);
            }
    return jacobian;
}

WavenumberGaussian GaussianModel::largest_excess(const Matrix& residual) const {
    const Matrix known = (target_.weight.array() > 0.0).cast<double>();
    const Matrix smooth = smoothed(residual.cwiseProduct(known)).cwiseProduct(known);
    Eigen::Index o = 0, i = 0;
    const double peak = smooth.maxCoeff(&o, &i);
    return {std::max(peak, 1e-6), wavenumber(target_.emission.centre_nm(static_cast<int>(o))),
            std::log(usual_width), wavenumber(target_.excitation.centre_nm(static_cast<int>(i))),
            std::log(usual_width)};
}

} // namespace reradiant
