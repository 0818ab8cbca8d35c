#include "host/fit/models/gaussian_model.h"
#include "tests/fit/fit_cases.h"

#include <gtest/gtest.h>

using namespace reradiant;

// Models `gaussians` and `matrix`.

namespace {

FitResult fit_with(FitModel model, const BispectralData& data, std::optional<int> rank = {}) {
    FitSettings settings;
    settings.model = model;
    settings.rank = rank;
    return fit_reradiation(data, settings);
}

} // namespace

TEST(Gaussians, JacobianIsThatOfTheMatrix) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    FitTarget target;
    target.emission = truth.emission;
    target.excitation = truth.excitation;
    target.value = truth.values;
    target.weight = Eigen::MatrixXd::Ones(41, 49);
    target.allowed = allowed_entries(target.emission, target.excitation, false);
    const PhotonPenalty penalty(target);
    const GaussianModel model(target, 2, penalty, RobustLoss::None);
    Eigen::VectorXd p(10);
    p << 0.8, 1.7, -2.3, 1.95, -2.0, 0.5, 2.1, -2.4, 2.6, -1.9;
    const Eigen::MatrixXd jacobian = model.entry_jacobian(p);
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        Eigen::VectorXd up = p, down = p;
        up(k) += 1e-5;
        down(k) -= 1e-5;
        const Eigen::MatrixXd slope = (model.matrix(up) - model.matrix(down)) / 2e-5;
        // Central differences err by step^2 times the third derivative, of order 1e3.
        EXPECT_LE((jacobian.col(k) - slope.reshaped()).norm(), 1e-5) << k;
    }
}

TEST(Gaussians, BandsThatAreNearlyGaussianAreFound) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    const double noise = 0.01 * stokes_peak(truth);
    const FitResult fit = fit_with(FitModel::Gaussians, noisy_data(truth, noise, true, 3));
    EXPECT_EQ(fit.failure, "");
    EXPECT_GE(fit.rank, 2);
    EXPECT_EQ(fit.bytes, 20u * static_cast<unsigned>(fit.rank));
    EXPECT_EQ(fit.anti_stokes_energy, 0.0);
    // Bands are Gaussian in wavelength here, so that a few terms in wavenumber must share them.
    EXPECT_LE(stokes_rmse(fit.matrix, truth), 1.0 * noise);
}

TEST(MatrixFit, AveragesOverNeighbours) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    const double noise = 0.05 * stokes_peak(truth);
    const FitResult fit = fit_with(FitModel::Matrix, noisy_data(truth, noise, true, 3));
    EXPECT_EQ(fit.failure, "");
    EXPECT_LE(fit.trace.kkt, 1e-8);
    EXPECT_GE(fit.matrix.values.minCoeff(), 0.0);
    EXPECT_EQ(fit.anti_stokes_energy, 0.0);
    EXPECT_LE(stokes_rmse(fit.matrix, truth), 0.6 * noise);
    const double covered = coverage(fit, truth);
    EXPECT_GE(covered, 0.90);
}

TEST(MatrixFit, NoiseFreeDataComeBack) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    const FitResult fit = fit_with(FitModel::Matrix, noisy_data(truth, 0.0, false, 3));
    EXPECT_EQ(fit.failure, "");
    EXPECT_LE(fit.relative_rmse, 1e-4);
}
