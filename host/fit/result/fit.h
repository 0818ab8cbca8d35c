#pragma once

#include "host/fit/data/bispectral_data.h"
#include "host/fit/data/fit_mask.h"
#include "host/fit/solver/non_negative_solver.h"
#include "host/fit/solver/robust_loss.h"
#include "host/fit/stack/stack_inversion.h"
#include "host/layers/stack/stack.h"
#include "host/spectral/matrix/reradiation.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

enum class FitModel { Factors, Gaussians, Matrix };
/// `factors`, `gaussians` or `matrix`; input Error otherwise.
FitModel fit_model_from_name(const std::string& name);
const char* fit_model_name(FitModel model);

inline constexpr int largest_factor_rank = 4;
inline constexpr int largest_gaussian_count = 24;

struct FitSettings {
    FitModel model = FitModel::Factors;
    std::optional<int> rank;  ///< terms of `factors` (to 4) or `gaussians` (to 24); empty: evidence
    bool anti_stokes = false; ///< emission below excitation is fitted, too
    RobustLoss loss = RobustLoss::None;
    /// Spacing of the spline functions of `factors`; 0 or empty: one number a band.
    std::optional<double> smooth_nm;
    /// Largest compact form of `factors`: where one number a band takes more, values are kept at
    /// the bands that matter most and the curves are linear between them. Not with smooth_nm.
    std::optional<std::size_t> most_bytes;
    /// Entries with |emission - excitation| up to this are not used: the reflected light that
    /// spills over from the diagonal. Empty: one emission step.
    std::optional<double> spill_nm;
    MaskRules mask;                  ///< entries that count as not measured
    std::optional<LayerStack> stack; ///< what lay above the sample; empty: nothing did
    UnknownLayers unknown;           ///< numbers of the stack that are fitted with the matrix
    int starts = 3;                  ///< initial guesses that are tried
    SolverSettings solver;
    unsigned seed = 0; ///< of the random starts
    int threads = 0;   ///< 0: all; the result is the same with any number
};

/// Photons emitted over photons absorbed (1 - diagonal), with its 95 % band; NaN: unknown.
struct QuantumYield {
    double value, low, high;
};

/// A curve of every term on its bands, (bands, terms), with its standard errors.
struct FittedCurves {
    Eigen::MatrixXd value, sigma;
};

struct FitResult {
    FitModel model = FitModel::Factors;
    int rank = 0;            ///< terms; of `matrix` the numerical rank is not looked for: 0
    double spacing_nm = 0.0; ///< of the splines of `factors`; 0: one number a band
    /// Bands whose values the curves keep, being linear between them; empty: they keep all.
    std::vector<double> emission_knots_nm, excitation_knots_nm;
    /// Per-band, rows = emission, on the data's grid: model off the diagonal; the data's diagonal,
    /// lowered within its noise where more photons would leave than arrive.
    ReradiationMatrix matrix;
    Eigen::MatrixXd sigma; ///< standard error of every entry of `matrix`, NaN: unknown
    Eigen::MatrixXd data;  ///< what was fitted (through the layer: of the substrate), NaN: missing
    Eigen::MatrixXd used;  ///< 1 where an entry of `data` took part in the fit, else 0
    FitMask mask;          ///< entries that were taken as not measured
    FittedCurves emission; ///< integral 1 over emission, 1/nm; empty for `matrix`
    FittedCurves excitation; ///< share of the irradiance that the term would emit untruncated
    double noise = 0.0;      ///< median standard error of the data
    bool noise_is_estimated = false;
    double reduced_chi_squared = 0.0;
    double rmse = 0.0, relative_rmse = 0.0; ///< as in `fit --json`
    std::size_t bytes = 0;
    SolveTrace trace;
    double seconds = 0.0;
    std::vector<QuantumYield> quantum_yield; ///< one a term
    double anti_stokes_energy = 0.0; ///< share of the off-diagonal energy at emission < excitation
    int parameters = 0, covariance_rank = 0; ///< numbers fitted; of them told apart by the data
    std::optional<StackEstimate> stack;      ///< when something of the stack was unknown
    std::vector<std::string> notes, warnings;
    /// Empty, or how far residuals are from noise: there is more in the data than in the model.
    std::string shortfall;
    /// Empty, or why the result must not be used: it did not converge or failed a check.
    std::string failure;
};

/// Fits a re-radiation matrix to data, bare or through a stack. Input Error (with the data's file)
/// when there are fewer data than parameters, for ranks out of range and for geometries that the
/// stack would need. A result that did not converge says so in `failure`.
FitResult fit_reradiation(const BispectralData& data, const FitSettings& settings);

} // namespace reradiant
