#pragma once

#include "reradiant/fluorophore.h"
#include "reradiant/spectrum.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// The form a matrix is in. Every function and file names it.
enum class MatrixQuantity { PerBand, DensityPerNm };
/// A model must satisfy the physics; a measurement holds noise.
enum class MatrixKind { Model, Measured };

/// Re-radiation (Donaldson) matrix, always held in per-band form with rows = emission:
/// exitance[o] = sum_i values(o, i) * irradiance[i], unit 1, spectral quantities per nm.
/// values(o, i) = F(lambda_o, mu_i) * excitation step for lambda_o != mu_i; where the two cells
/// coincide the entry is the reflectance plus the fluorescence within the cell.
/// Emission and excitation grids may differ in range and in step.
struct ReradiationMatrix {
    WavelengthGrid emission;
    WavelengthGrid excitation;
    Eigen::MatrixXd values; ///< (emission.count, excitation.count)
    MatrixKind kind = MatrixKind::Model;
    bool anti_stokes_allowed = false;
    std::string geometry = {}; ///< as the file says, e.g. "45/0"; may be empty

    /// Reflectance: the diagonal at each excitation wavelength that is also an emission centre,
    /// as a table spectrum (linear between, constant outside).
    Spectrum reflectance() const;
    /// Values with the diagonal (equal wavelengths) set to zero.
    Eigen::MatrixXd fluorescent_part() const;
    /// True when some off-diagonal entry is not zero.
    bool is_fluorescent() const;
};

/// Emission band whose centre is the excitation band's centre (to 1e-6 of the smaller step): the
/// row of the diagonal entry. -1 when there is none.
int diagonal_row(const ReradiationMatrix& matrix, int excitation_band);

/// A matrix from fluorophores plus reflectance on given grids, each entry the mean over its
/// emission cell of the integral over its excitation cell (1 nm or finer quadrature). The
/// fluorescence within a cell is part of the diagonal.
ReradiationMatrix matrix_from_fluorophores(const std::vector<Fluorophore>& fluorophores,
                                           const Spectrum& reflectance,
                                           const WavelengthGrid& emission,
                                           const WavelengthGrid& excitation);

/// Per excitation column: radiant sum (sum_o values * emission step / excitation step, the
/// diagonal counted once and unscaled) and photon sum (each weighted by lo / li).
struct ColumnBalance {
    std::vector<double> radiant, photons;
};
ColumnBalance column_balance(const ReradiationMatrix& matrix);

/// A `MatrixRepair` says what was changed in order to use a matrix for rendering.
struct MatrixRepair {
    int negative_entries = 0;
    double negative_energy = 0.0; ///< sum of |negative| over the sum of all positive entries
    int anti_stokes_entries = 0;
    double anti_stokes_energy = 0.0;
    std::string text() const; ///< one line; empty when nothing changed
};

/// Checks a matrix and makes it usable for rendering (spectra/README.md):
/// a model that is negative beyond 1e-6, breaks energy (a column over 1 + 1e-6) or has
/// anti-Stokes entries without leave throws std::invalid_argument naming the column; entries
/// between -1e-6 and 0 become 0 and are reported. A measurement has negative and anti-Stokes
/// entries set to zero, reported; it is refused only when it breaks energy beyond 1 + 1e-6
/// after that. `warnings` gets photon sums over 1 + 1e-6, scatter, and what shows a misreading.
MatrixRepair repair_for_rendering(ReradiationMatrix& matrix, std::vector<std::string>& warnings);

/// The fluorescent part on the cells of `cells`, conserving energy: entry (o, i) is the mean over
/// emission cell o of the integral over excitation cell i of F, F piecewise constant on the
/// matrix's own cells. What leaves and enters within one cell lands on the diagonal.
/// Square, (cells.count, cells.count), rows = emission.
Eigen::MatrixXd fluorescence_on_cells(const ReradiationMatrix& matrix, const WavelengthGrid& cells);

/// diag + strictly lower triangle of a rank-K product: lower(o, i) = [o > i] sum_k e(o,k) x(i,k).
struct MaskedFactors {
    Eigen::MatrixXd emission;    ///< (bands, K), all >= 0
    Eigen::MatrixXd excitation;  ///< (bands, K), all >= 0
    double relative_error = 0.0; ///< Frobenius norm of the rest over that of the lower triangle
    int rank() const { return static_cast<int>(emission.cols()); }
};

/// The factors that fluorophores have by themselves, one term each: of the strictly lower triangle
/// of matrix_from_fluorophores on a square grid, exact but for excitation cells that send less than
/// 1e-12 of the most to others. std::invalid_argument as there.
MaskedFactors factors_of_fluorophores(const std::vector<Fluorophore>& fluorophores,
                                      const WavelengthGrid& cells);

/// Non-negative factors of the strictly lower triangle of a square matrix, the smallest rank
/// <= max_rank whose relative error is at most `tolerance`, else the best of rank max_rank.
/// Rank 0 for a zero triangle. Upper triangle and diagonal are not looked at.
MaskedFactors factorise_lower(const Eigen::MatrixXd& square, int max_rank, double tolerance);

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
