#pragma once

#include "host/fit/dye/dye_model.h"
#include "host/fit/result/error_bands.h"

#include <Eigen/Core>

namespace reradiant {

/// The Gauss-Newton covariance of all parameters at a minimum, with an active set (error_bands.h).
struct DyeCovariance {
    Covariance covariance;
    double variance = 1.0; ///< by which noise is larger than the weights say
    Eigen::VectorXd sigma; ///< by parameter
};
DyeCovariance dye_covariance(const DyeModel& model, const Eigen::VectorXd& packed,
                             bool noise_is_estimated);

/// Coefficients of a kind of spectra that the data do not show: from the best seen one on all that
/// are uncertain beside it, beyond the first that is no larger than two standard errors. A dye that
/// absorbs nothing at short waves, for example, says nothing of an emission there, nor does one of
/// its absorption where it sends out nothing; that is looked for towards longer waves alone.
enum class DyeSpectrum { Absorption, Emission };
std::vector<Eigen::Index> unseen_coefficients(const DyeModel& model, DyeSpectrum which,
                                              const Eigen::VectorXd& packed,
                                              const Eigen::VectorXd& sigma);

/// Errors of fitted dyes.
struct DyeErrors {
    Eigen::MatrixXd absorption, emission; ///< standard errors, (bands, dyes); emission adds up to 1
    Eigen::VectorXd reflectance;
    std::vector<BandedNumber> quantum_yield, absorption_at_peak; ///< by dye
    BandedNumber scale;
};

/// Errors from a covariance. Coefficients that are held as unseen have the standard errors `unseen`
/// (by parameter, else 0). A yield or a peak whose standard error is not small is as uncertain as
/// the chi squared profile says: its band ends where no other numbers fit better than 3.84 worse,
/// or where what is possible ends.
DyeErrors dye_errors(const DyeModel& model, const Eigen::VectorXd& packed,
                     const DyeCovariance& covariance, const Eigen::VectorXd& unseen,
                     const SolverSettings& settings);

} // namespace reradiant
