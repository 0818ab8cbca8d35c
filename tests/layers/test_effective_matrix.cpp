#include "host/layers/models/effective_matrix.h"
#include "reradiant/error.h"

#include <gtest/gtest.h>

#include <random>

using namespace reradiant;

namespace {

SemiseparableMatrix random_matrix(int bands, int rank, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    SemiseparableMatrix m{Eigen::VectorXd(bands), Eigen::MatrixXd(bands, rank),
                          Eigen::MatrixXd(bands, rank)};
    for (int i = 0; i < bands; ++i) {
        m.diagonal(i) = 0.9 * uniform(generator);
        for (int k = 0; k < rank; ++k) {
            m.emission(i, k) = uniform(generator) / (0.5 * bands * rank);
            m.excitation(i, k) = uniform(generator);
        }
    }
    return m;
}

Eigen::VectorXd random_feedback(int bands, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    return Eigen::VectorXd::NullaryExpr(bands, [&] { return uniform(generator); });
}

} // namespace

TEST(EffectiveMatrix, EqualsTheSumOfInterreflections) {
    const Eigen::MatrixXd m = random_matrix(12, 2, 1).dense();
    const Eigen::VectorXd r = 0.6 * random_feedback(12, 2);
    Eigen::MatrixXd sum = m, term = m;
    for (int order = 0; order < 200; ++order) {
        term = (m * r.asDiagonal() * term).eval();
        sum += term;
    }
    EXPECT_LT((effective_matrix(m, r) - sum).norm(), 1e-12 * sum.norm()); // rounding
}

TEST(EffectiveMatrix, FactoredFormEqualsTheDenseSolve) {
    for (const int bands : {1, 2, 49, 400}) {
        for (const int rank : {0, 1, 4}) {
            const SemiseparableMatrix m = random_matrix(bands, rank, 3);
            const Eigen::VectorXd r = random_feedback(bands, 4);
            const Eigen::MatrixXd dense = effective_matrix(m.dense(), r);
            const Eigen::MatrixXd factored = effective_semiseparable(m, r).dense();
            EXPECT_LT((factored - dense).cwiseAbs().maxCoeff(), 1e-10 * dense.cwiseAbs().maxCoeff())
                << bands << " bands, rank " << rank;
        }
    }
}

TEST(EffectiveMatrix, Case22AndCase28FeedbackCloseToOneIsSolvedAndAtOneIsRefused) {
    // lower triangle plus a coupling back, scaled to a known spectral radius
    Eigen::MatrixXd m(2, 2);
    m << 0.5, 0.5, 0.5, 0.5; // spectral radius 1
    const double radius = 0.999999;
    const Eigen::MatrixXd effective = effective_matrix(m, Eigen::VectorXd::Constant(2, radius));
    // M is a projection: M (1 - radius M)^-1 = M / (1 - radius)
    EXPECT_NEAR(effective(0, 1) * (1.0 - radius) / 0.5, 1.0, 1e-6);
    EXPECT_THROW(effective_matrix(m, Eigen::VectorXd::Ones(2)), Error);
    EXPECT_THROW(effective_matrix(2.0 * m, Eigen::VectorXd::Constant(2, 0.7)), Error);
    SemiseparableMatrix s{Eigen::VectorXd::Constant(3, 1.0), Eigen::MatrixXd::Ones(3, 1),
                          Eigen::MatrixXd::Ones(3, 1)};
    EXPECT_THROW(effective_semiseparable(s, Eigen::VectorXd::Ones(3)), Error);
    EXPECT_NO_THROW(effective_semiseparable(s, Eigen::VectorXd::Constant(3, radius)));
}

TEST(EffectiveMatrix, SizesThatDisagreeAreRefused) {
    EXPECT_THROW(effective_matrix(Eigen::MatrixXd::Zero(2, 3), Eigen::VectorXd::Zero(2)), Error);
    EXPECT_THROW(effective_matrix(Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(3)), Error);
}
