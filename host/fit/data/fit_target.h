#pragma once

#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

namespace reradiant {

/// The fluorescent part of one bare matrix, ready to be fitted. All matrices are (emission,
/// excitation). Values are divided by `scale`, so that the peak is of order 1.
struct FitTarget {
    WavelengthGrid emission, excitation;
    Eigen::MatrixXd value;   ///< 0 where the weight is 0
    Eigen::MatrixXd weight;  ///< 1 / standard error, 0: not used (not measured, saturated, spill)
    Eigen::MatrixXd allowed; ///< 1 where the model may emit, else 0
    Eigen::MatrixXd photons; ///< share of a photon that one unit of an entry stands for
    // Photon sums of every excitation column, in units of `scale`:
    Eigen::VectorXd budget;       ///< the largest there can be, that of a black diagonal
    Eigen::VectorXd spare;        ///< what the measured diagonal leaves
    Eigen::VectorXd spare_weight; ///< 1 / standard error of `spare`, 0: no diagonal was measured
    double scale = 1.0;

    Eigen::Index used_count() const { return (weight.array() > 0.0).count(); }
    /// Square sum of (model - value) * weight.
    double chi_squared(const Eigen::MatrixXd& model) const {
        return (model - value).cwiseProduct(weight).squaredNorm();
    }
    /// Photon sum of every column of a model in units of `scale`.
    Eigen::VectorXd photon_sums(const Eigen::MatrixXd& model) const {
        return model.cwiseProduct(photons).colwise().sum().transpose();
    }
};

/// lo/li times the ratio of steps; at least the ratio of steps (the energy balance) where emission
/// lies below excitation.
Eigen::MatrixXd photon_weights(const WavelengthGrid& emission, const WavelengthGrid& excitation);

/// 1 where emission > excitation, or off the diagonal when anti-Stokes emission is allowed.
Eigen::MatrixXd allowed_entries(const WavelengthGrid& emission, const WavelengthGrid& excitation,
                                bool anti_stokes);

} // namespace reradiant
