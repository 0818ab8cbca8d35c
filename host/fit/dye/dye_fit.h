#pragma once

#include "reradiant/bispectral_data.h"
#include "reradiant/fit.h"
#include "reradiant/scene.h"

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

inline constexpr int most_fitted_dyes = 2;

/// What is known of a sample whose dyes are looked for.
struct DyeFitSettings {
    Material material;     ///< layers and a Lambertian substrate, or a sheet
    std::size_t layer = 0; ///< index of the layer whose dyes are not known; those given are ignored
    std::optional<int> dyes;           ///< how many; empty: evidence
    std::vector<double> thickness;     ///< of the layer, by data set; empty: the material's
    std::vector<double> concentration; ///< of the dyes, by data set, relative; empty: 1
    bool is_arbitrary_unit = false;    ///< the data's unit is an unknown one, the same in all
    std::optional<Spectrum>
        lamp; ///< the data are not corrected for this spectrum of the excitation
    std::optional<double> ceiling; ///< values from here up are saturated
    bool fits_substrate = false;   ///< the substrate's reflectance is not known either
    MaskRules mask;
    std::optional<double> spill_nm;  ///< as in FitSettings
    std::optional<double> smooth_nm; ///< spacing of the spectra's splines; 0: one number a band
    SolverSettings solver{.most_iterations = 200};
};

/// A number with its 95 % band. The band is all that is possible where the data do not tell.
struct BandedNumber {
    double value = 0.0, low = 0.0, high = 0.0;
};

/// A dye as the data have it. Spectra are on the common bands of emission and excitation.
struct FittedDye {
    /// Per unit of the layer's thickness at concentration 1, natural logarithm.
    Eigen::VectorXd absorption, absorption_sigma;
    Eigen::VectorXd emission, emission_sigma; ///< power, 1/nm; integral 1
    BandedNumber quantum_yield;               ///< photons sent out over photons absorbed
    /// Optical depth of the thickest data set's layer where the dye absorbs most.
    BandedNumber peak_depth;
};

/// How well so many dyes fit: chi squared and Schwarz's criterion (lower is better).
struct DyeEvidence {
    int dyes = 0;
    double chi_squared = 0.0, criterion = 0.0;
    int parameters = 0;
    bool converged = false;
};

/// One data set beside its fit: one matrix a block, (emission, excitation), in the data's unit.
struct FittedDyeData {
    BispectralData data;
    std::vector<Eigen::MatrixXd> model, used; ///< used: 1 where an entry took part, else 0
    FitMask mask;
    int saturated = 0;
    double depth_factor = 1.0; ///< thickness times concentration: depth = factor * absorption
};

struct DyeFitResult {
    WavelengthGrid bands;
    std::vector<FittedDye> dyes;
    std::vector<FittedDyeData> sets;
    std::optional<BandedNumber> scale; ///< data over radiance factors, of arbitrary units
    Eigen::VectorXd reflectance, reflectance_sigma; ///< of a fitted substrate, else empty
    std::vector<DyeEvidence> evidence;              ///< one a number of dyes that was tried
    /// Yield of all dyes together by the inner-filter correction, which leaves out what is
    /// re-absorbed and sent out again; NaN for geometries, units and grounds it does not know.
    double inner_filter_yield = 0.0;
    ReradiationMatrix matrix; ///< of the dyes by themselves, see fit_dyes
    double spacing_nm = 0.0;
    int data_count = 0, parameters = 0, covariance_rank = 0;
    double noise = 0.0, reduced_chi_squared = 0.0, rmse = 0.0, relative_rmse = 0.0;
    bool noise_is_estimated = false;
    SolveTrace trace;
    double seconds = 0.0;
    std::vector<std::string> notes, warnings;
    std::string shortfall, failure; ///< as in FitResult
};

/// Reads bispectral data of a dyed sample: as read_bispectral_data, but light that dyes in slabs
/// sent out counts as all other (CSV of `measure`, both sides of a sheet), and values of an
/// arbitrary unit may be of any size.
BispectralData read_dye_data(const std::filesystem::path& file, bool is_arbitrary_unit);

/// Fits the dyes of a layer to data of one or several samples that differ in its thickness or
/// concentration. `matrix` of the result is what the layer of the first set would send back per
/// light that falls on it at right angles, were nothing else there and nothing absorbed twice: the
/// share absorbed times what is sent out. Input Error for a layer that is not there, for grids or
/// lists that do not belong together and where nothing is left to fit.
DyeFitResult fit_dyes(const std::vector<BispectralData>& data, const DyeFitSettings& settings);

/// Writes a MATERIAL.toml with the fitted dyes in one of its layers (index) and with the optical
/// depth of the first data set, as a file that `render` and `measure` take. Files that the material
/// names are named from the new file's folder. Atomic.
void write_dye_material(const std::filesystem::path& file, const DyeFitResult& result,
                        const std::filesystem::path& material, std::size_t layer);

} // namespace reradiant
