#include "host/fit/models/model_selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace reradiant {
namespace {

/// One entry that is its only parameter, whose prior is a normal deviate of width 2.
class OneNumber final : public TermModel {
public:
    static constexpr double prior_width = 2.0;

    std::vector<int> block_sizes() const override { return {1}; }
    void add_residuals(ceres::Problem&, const std::vector<double*>&) const override {}
    Eigen::MatrixXd matrix(const Eigen::VectorXd& p) const override { return p; }
    std::size_t stored_numbers() const override { return 1; }
    int terms() const override { return 1; }
    int term_of(Eigen::Index) const override { return 0; }
    FactorCurves curves(const Eigen::VectorXd& p) const override {
        return {p, Eigen::MatrixXd::Ones(1, 1)};
    }
    Eigen::MatrixXd entry_jacobian(const Eigen::VectorXd&) const override {
        return Eigen::MatrixXd::Ones(1, 1);
    }
    Eigen::MatrixXd prior_jacobian() const override {
        return Eigen::MatrixXd::Constant(1, 1, 1.0 / prior_width);
    }
    int free_units() const override { return 0; }
};

/// -2 log of the integral of likelihood times prior over x > 0, by the midpoint rule.
double integrated(double value, double weight) {
    constexpr double step = 1e-4;
    double sum = 0.0;
    for (double x = 0.5 * step; x < 20.0; x += step) {
        const double chi = weight * (x - value), prior = x / OneNumber::prior_width;
        sum += step * std::exp(-0.5 * (chi * chi + prior * prior));
    }
    return -2.0 * std::log(sum / (OneNumber::prior_width * std::sqrt(2.0 * std::numbers::pi)));
}

double criterion(double value, double weight) {
    FitTarget target;
    target.value = Eigen::MatrixXd::Constant(1, 1, value);
    target.weight = Eigen::MatrixXd::Constant(1, 1, weight);
    const double w = weight * weight, p = 1.0 / std::pow(OneNumber::prior_width, 2);
    ModelFit fit;
    fit.parameters = Eigen::VectorXd::Constant(1, std::max(0.0, w * value / (w + p)));
    fit.chi_squared = target.chi_squared(fit.parameters);
    return laplace_criterion(OneNumber(), fit, target, Evidence::KnownNoise);
}

TEST(LaplaceCriterion, IsTheIntegralWhereItIsNormal) {
    EXPECT_NEAR(criterion(3.0, 10.0), integrated(3.0, 10.0), 1e-3);
}

TEST(LaplaceCriterion, IsTheIntegralOfAParameterPushedAgainstZero) {
    for (const double value : {0.0, -0.1, -0.3, -2.0})
        EXPECT_NEAR(criterion(value, 10.0), integrated(value, 10.0), 0.03) << value;
}

TEST(LaplaceCriterion, MoreThanNoiseIsEvidenceForAParameter) {
    const auto of_nothing = [](double value, double weight) { return std::pow(weight * value, 2); };
    EXPECT_LT(criterion(3.0, 10.0), of_nothing(3.0, 10.0));
    EXPECT_GT(criterion(0.05, 10.0), of_nothing(0.05, 10.0));
}

} // namespace
} // namespace reradiant
