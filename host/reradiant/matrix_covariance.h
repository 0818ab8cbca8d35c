#pragma once

#include "reradiant/reradiation.h"

#include <Eigen/Core>

#include <filesystem>
#include <optional>

namespace reradiant {

/// What is uncertain about the entries of a re-radiation matrix in per-band form: the covariance of
/// two entries a and b is sum_k directions(a, k) directions(b, k), and independent(a)^2 more where
/// a is b. Entries count in column-major order of (emission, excitation).
struct MatrixCovariance {
    WavelengthGrid emission, excitation;
    Eigen::MatrixXd directions;  ///< (entries, K); what one standard error of it adds to the matrix
    Eigen::MatrixXd independent; ///< (emission, excitation), a standard error; NaN: not known
    /// The matrix that this belongs to, (emission, excitation), where that is known.
    std::optional<Eigen::MatrixXd> matrix = {};

    /// Standard error of every entry, (emission, excitation); NaN: not known.
    Eigen::MatrixXd standard_errors() const;
};

/// Every entry has an error of its own: `errors` holds a standard error an entry, on its grids.
/// std::invalid_argument for a negative one.
MatrixCovariance independent_errors(const ReradiationMatrix& errors);

/// The same covariance in fewer directions: those that together hold less than 1e-8 of the variance
/// become independent errors of the entries, whose standard errors stay what they are.
MatrixCovariance in_fewer_directions(const MatrixCovariance& covariance);

/// std::invalid_argument where a covariance is not that of a matrix: it has other bands, or it is
/// known to belong to other values (beyond the rounding of single precision).
void require_covariance_of(const ReradiationMatrix& matrix, const MatrixCovariance& covariance);

/// Reads what write_covariance_csv writes. Input Error with the place for what is malformed,
/// incomplete or negative.
MatrixCovariance read_covariance_csv(const std::filesystem::path& file);

/// Writes the CSV that spectra/README.md describes; atomic. Numbers have six digits, but for the
/// matrix, which is as write_reradiation has it.
void write_covariance_csv(const std::filesystem::path& file, const MatrixCovariance& covariance);

} // namespace reradiant
