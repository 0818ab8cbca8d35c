#pragma once

#include "host/fit/data/fit_target.h"
#include "host/fit/factors/smooth_basis.h"
#include "host/fit/models/fitted_model.h"
#include "host/fit/models/photon_penalty.h"
#include "host/fit/solver/robust_loss.h"

#include <array>
#include <limits>
#include <optional>
#include <utility>

namespace reradiant {

/// Model `factors`: entry (o, i) = allowed(o, i) sum_k e_k(o) x_k(i) with e = emission basis times
/// coefficients, x likewise, all coefficients non-negative. One parameter block holds the K
/// coefficients of one basis function: first the emission's, then the excitation's. Coefficients
/// have weak priors: of their size, and of their second differences, so that a curve goes on from
/// its neighbours where nothing is measured, as it is beside the diagonal.
class FactorModel final : public TermModel {
public:
    /// bend_width: standard deviation of second differences of values 10 nm apart, in units where
    /// a curve's peak is about 1; on other grids it goes with the square of the step, as those of
    /// smooth curves do. See bend_of_bands and bend_of_lines.
    FactorModel(const FitTarget& target, int rank, const SmoothBasis& emission,
                const SmoothBasis& excitation, const PhotonPenalty& penalty, RobustLoss loss,
                double bend_width);

    /// Values of bend_width for molecular bands, whose second differences on 10 nm reach 0.3 at a
    /// peak and are less elsewhere, and for lines, which have 2 on any grid.
    static constexpr double bend_step_nm = 10.0, bend_of_bands = 0.1;
    static constexpr double bend_of_lines = std::numeric_limits<double>::infinity();

    std::vector<int> block_sizes() const override;
    void add_residuals(ceres::Problem& problem, const std::vector<double*>& blocks) const override;

    /// The excitation's.
    std::pair<std::size_t, std::size_t> affine_blocks() const override {
        return {static_cast<std::size_t>(emission_.size()),
                static_cast<std::size_t>(excitation_.size())};
    }

    FactorCurves curves(const Eigen::VectorXd& parameters) const override;
    Eigen::MatrixXd matrix(const Eigen::VectorXd& parameters) const override;
    Eigen::MatrixXd entry_jacobian(const Eigen::VectorXd& parameters) const override;
    Eigen::MatrixXd prior_jacobian() const override;
    int terms() const override { return rank_; }
    int term_of(Eigen::Index parameter) const override {
        return static_cast<int>(parameter % rank_);
    }
    int free_units() const override { return 1; }
    /// Coefficients, and where chosen knots lie.
    std::size_t stored_numbers() const override;
    Eigen::VectorXd parameters(const Eigen::MatrixXd& emission_coefficients,
                               const Eigen::MatrixXd& excitation_coefficients) const;
    /// Coefficients, (functions, K).
    Eigen::MatrixXd emission_coefficients(const Eigen::VectorXd& parameters) const;
    Eigen::MatrixXd excitation_coefficients(const Eigen::VectorXd& parameters) const;
    /// Makes both curves of every term equally long; the matrix stays.
    void balance(Eigen::VectorXd& parameters) const;

private:
    /// Returns the basis of the emission, then that of the excitation, each with its grid.
    std::array<std::pair<const SmoothBasis&, const WavelengthGrid&>, 2> bases() const {
        return {{{emission_, target_.emission}, {excitation_, target_.excitation}}};
    }

    /// Returns the prior's standard deviation of second differences of a basis's coefficients;
    /// nothing for functions that are not evenly spaced.
    std::optional<double> bend_width(const SmoothBasis& basis, const WavelengthGrid& grid) const;

    const FitTarget& target_;
    int rank_;
    SmoothBasis emission_, excitation_;
    const PhotonPenalty& penalty_;
    RobustLoss loss_;
    double bend_width_;
};

} // namespace reradiant
