#pragma once

#include "reradiant/reradiation.h"
#include "reradiant/spectral_files.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// Directions of a bispectral measurement, as `measure` has them: phi is the azimuth of the
/// outgoing direction from the incident one, 180 is the mirror side.
struct BispectralGeometry {
    double theta_i_deg, theta_o_deg, phi_deg;

    bool operator==(const BispectralGeometry&) const = default;
};

/// A `BispectralBlock` holds what one geometry saw. Both matrices are (emission, excitation) with
/// rows = emission.
struct BispectralBlock {
    /// Empty: a bare Lambertian sample, values are its re-radiation matrix itself.
    std::optional<BispectralGeometry> geometry;
    /// pi f(wo, lo; wi, li), unit 1, per-band form (the radiance factor; the matrix itself for a
    /// bare Lambertian sample). NaN: not measured.
    Eigen::MatrixXd value;
    Eigen::MatrixXd sigma; ///< standard error of `value`; NaN: unknown
};

struct BispectralData {
    std::filesystem::path file;
    WavelengthGrid emission, excitation;
    std::vector<BispectralBlock> blocks;
    bool anti_stokes_allowed = false;
    std::string geometry = {}; ///< as the file says, e.g. "45/0"; may be empty

    /// Entries that were measured (finite), over all blocks.
    Eigen::Index measured_count() const;
};

/// Reads measured data by its ending: .csv (the CSV of spectra/README.md, where `nan` stands
/// for an entry that was not measured, or the CSV of `measure`, whose diffuse rows are taken), .bfc
/// or .exr. Values are raw: negative and anti-Stokes entries stay. Input Error with the place for
/// what is malformed, contradictory or out of range. `form` is what a plain table does not say of
/// itself. Logs what speaks against the reading (matrix_warnings.h).
BispectralData read_bispectral_data(const std::filesystem::path& file, const TableForm& form = {});

/// Writes what read_bispectral_data reads back: one block without geometry as a re-radiation CSV
/// of kind `measured` (without its sigma), blocks with geometries as the CSV of `measure`. Atomic.
/// std::invalid_argument for several blocks of which one has no geometry.
void write_bispectral_data(const std::filesystem::path& file, const BispectralData& data);

} // namespace reradiant
