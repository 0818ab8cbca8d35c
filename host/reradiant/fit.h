#pragma once

#include "reradiant/bispectral_data.h"
#include "reradiant/interruption.h"
#include "reradiant/layer_stack.h"
#include "reradiant/reradiation.h"
#include "reradiant/scatter_line.h"

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

class SolveJournal; // host/fit/solver/solve_journal.h

/// Entries whose band centres lie within both ranges, ends included.
struct MaskBox {
    double excitation_from_nm, excitation_to_nm, emission_from_nm, emission_to_nm;

    bool operator==(const MaskBox&) const = default;
};

/// Which entries of measured data a fit takes as missing.
struct MaskRules {
    bool automatic = true; ///< lines of scatter that stand out
    std::vector<ScatterLine> lines;
    std::vector<MaskBox> boxes;

    bool operator==(const MaskRules&) const = default;
};

/// Reads `none`, or a list between commas of `auto`, `first:NM`, `second:NM`, `third:NM`, `half:NM`
/// (half widths of lines of scatter) and `box:FROM-TOxFROM-TO` (nm of excitation x emission). Input
/// Error for anything else, for an order that is named twice and for ranges that are empty.
MaskRules mask_rules_from_text(const std::string& text);

/// Returns rules in the form that mask_rules_from_text reads; reading it gives the same rules.
std::string mask_rules_text(const MaskRules& rules);

/// Entries of measured data that a fit takes as missing, and why.
struct FitMask {
    MaskRules rules;                 ///< as applied: lines that were found stand among the others
    std::vector<FoundScatter> found; ///< those that stood out by themselves
    Eigen::MatrixXd entries;         ///< 1: masked, else 0, (emission, excitation); empty: none is
    int measured = 0;                ///< masked entries that some block measured
    std::vector<std::string> notes, warnings;

    bool any() const { return measured > 0; }
};

enum class FitModel { Factors, Gaussians, Matrix };
/// `factors`, `gaussians` or `matrix`; input Error otherwise.
FitModel fit_model_from_name(const std::string& name);
const char* fit_model_name(FitModel model);

/// A `RobustLoss` says what a residual of s standard errors costs: s^2 / 2, or less for outliers.
enum class RobustLoss { None, Huber, Cauchy };

/// `none`, `huber` or `cauchy`; input Error otherwise.
RobustLoss robust_loss_from_name(const std::string& name);

/// `UnknownLayers` says what is not known about the stack above a sample.
struct UnknownLayers {
    bool thickness = false;  ///< one factor for each layer that absorbs
    bool absorption = false; ///< one factor for each layer's absorption
    bool ior = false;        ///< one addend for each layer

    bool any() const { return thickness || absorption || ior; }
};
/// A list like `thickness,ior`; input Error for another name.
UnknownLayers unknown_layers_from_names(const std::vector<std::string>& names);

/// A `StackEstimate` holds what the data say about the unknown numbers of a stack.
struct StackEstimate {
    std::vector<std::string> names; ///< "thickness of layer 1", ...
    Eigen::VectorXd value, sigma;   ///< sigma infinite: the data do not determine it
    Eigen::MatrixXd correlation;    ///< between the numbers; NaN where undetermined
    int rank = 0;                   ///< numbers that the data tell apart
    double reduced_chi_squared = 0.0;
    /// One sentence a group of numbers that the data cannot tell apart; empty when all are.
    std::vector<std::string> ambiguities;
};

struct SolverSettings {
    int most_iterations = 400;
    double kkt_tolerance = 1e-8;
    double most_seconds = 60.0;
    StopFlag stop = nullptr;         ///< asked before every step
    SolveJournal* journal = nullptr; ///< keeps every step, and has those of an earlier run
};

/// A `SolveTrace` says how a minimisation went.
struct SolveTrace {
    std::vector<double> cost, seconds; ///< after every step; seconds since `start`
    int iterations = 0;
    double kkt = 0.0; ///< see kkt_violation
    bool converged = false;
    std::string stop_reason;

    /// Appends steps that went on from the end of these.
    void append(const SolveTrace& more);
    double final_cost() const { return cost.empty() ? 0.0 : cost.back(); }
};

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
    bool covariance = false;         ///< FitResult::covariance is asked for; not with `matrix`
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
    /// What is uncertain about `matrix`: noise of the data through the model, that of the diagonal
    /// besides, and what the bound at zero makes of noise. Empty unless asked for.
    std::optional<MatrixCovariance> covariance;
    FittedCurves emission;   ///< integral 1 over emission, 1/nm; empty for `matrix`
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

/// Writes the fitted model as TOML: a [material] over a Lambertian substrate whose RERADIATION
/// holds one fluorophore a term (tables of its curves at the data's bands, whatever functions made
/// them) and the diagonal as reflectance. A `matrix` is named as a file: `matrix_file` (as written
/// beside it). Returns the largest difference between an entry that the scene's own integration
/// gives and the fitted one, relative to the largest entry; 0 for a `matrix`. Atomic.
double write_model_file(const std::filesystem::path& file, const FitResult& result,
                        const std::filesystem::path& matrix_file);

} // namespace reradiant
