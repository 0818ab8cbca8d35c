#pragma once

#include "reradiant/bispectral_data.h"
#include "reradiant/layer_stack.h"
#include "reradiant/reradiation.h"

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

namespace reradiant {

/// A `SynthInstrument` says what an instrument does to light besides its noise.
struct SynthInstrument {
    /// Full widths at half maximum of the triangular bandpasses; 0: a band sees the mean over its
    /// cell, as the true matrix has it.
    double excitation_fwhm_nm = 0.0, emission_fwhm_nm = 0.0;
    /// Share of the reflected light that each of the two emission bands beside the diagonal sees.
    double spill = 0.0;
    /// Share of the reflected light that is seen at twice its wavelength, too.
    double second_order = 0.0;
    /// Spectrum of the lamp that data are not corrected for (relative, mean 1 over the excitation
    /// bands); and what a radiance factor of 1 reads.
    std::optional<Spectrum> lamp = {};
    double scale = 1.0;
    std::optional<double> ceiling = {}; ///< largest reading
};

/// Standard deviations of one entry of signal s, where `peak` is the largest fluorescent entry of
/// the noise-free data: read_of_peak * peak, relative * s, and that of counting photons, of which
/// an entry as large as the peak gathers shot_counts_at_peak (0: no shot noise).
struct SynthNoise {
    double read_of_peak = 0.0;
    double shot_counts_at_peak = 0.0;
    double relative = 0.0;
};

/// A substrate of known fluorophores and how it is measured, through layers that may hold dyes of
/// their own.
struct SynthRecipe {
    WavelengthGrid emission{380.0, 10.0, 41}, excitation{300.0, 10.0, 49};
    std::vector<Fluorophore> fluorophores; ///< of the substrate
    Spectrum reflectance;
    LayerStack stack;                           ///< above the substrate; by the model `adding`
    std::vector<BispectralGeometry> geometries; ///< empty: the bare matrix itself is measured
    SynthInstrument instrument;
    SynthNoise noise;
};

/// Reads RECIPE.toml. Input Error with line and column for unknown keys, missing or contradictory
/// ones, values out of range, light that is both reflected and absorbed (reflectance and
/// absorptances over 1), and a stack without geometries.
SynthRecipe read_synth_recipe(const std::filesystem::path& file);

/// The substrate's matrix on the recipe's grids: what a fit should find.
ReradiationMatrix synth_truth(const SynthRecipe& recipe);

/// Returns what the instrument sees without noise and spill, one matrix (emission, excitation) for
/// each geometry: pi times the BRRDF's diffuse part and what dyes in layers add to it, or the
/// matrix itself without geometries. std::invalid_argument when the two grids are not parts of one
/// grid but must be (a stack without bandpasses), and when the bandpasses need too fine a grid.
std::vector<Eigen::MatrixXd> synth_noise_free(const SynthRecipe& recipe);

/// Adds the reflected light that emission bands beside the diagonal see, and that of the second
/// order.
void add_spill(const SynthRecipe& recipe, Eigen::MatrixXd& values);

struct SynthResult {
    BispectralData data;    ///< sigma: the noise's standard deviation at the noise-free signal
    double peak = 0.0;      ///< largest fluorescent entry without noise
    double noise_rms = 0.0; ///< over the off-diagonal entries
};

/// Noise-free data plus noise; the same seed gives the same data. std::invalid_argument as
/// synth_noise_free, and when nothing fluoresces on the recipe's grids.
SynthResult synthesise(const SynthRecipe& recipe, unsigned seed);

} // namespace reradiant
