#pragma once

#include "host/fit/dye/dye_fit.h"
#include "reradiant/synth.h"

#include <vector>

namespace reradiant {

/// A sample of known dyes in a varnish and how it is measured: at 45/0, by 41 x 49 bands of 10 nm.
struct DyeCase {
    int dyes = 1;
    std::vector<double> depths{1.0}; ///< optical depth at each dye's peak, one a data set
    double noise_of_peak = 0.01;
    double alpha = 0.0;       ///< of the varnish's face
    double reflectance = 0.9; ///< of the ground
};

/// The recipe of one of its data sets.
SynthRecipe dye_recipe(const DyeCase& what, double depth);
/// What a fit of the case is told: all but the dyes.
DyeFitSettings dye_settings(const DyeCase& what);

/// How far a fit is from what is true.
struct DyeError {
    double yield = 0.0;              ///< relative
    double peak_depth = 0.0;         ///< relative
    double absorption_of_peak = 0.0; ///< root mean square over the bands, over the peak
    double emission_of_peak = 0.0;   ///< likewise
    /// Share of the true values above 1 % of a spectrum's peak that the 95 % bands hold.
    double spectra_covered = 0.0;
    bool yield_is_covered = false, depth_is_covered = false;
};

/// Errors of the dye that is nearest to the k-th true one.
DyeError dye_error(const DyeCase& what, const DyeFitResult& result, int k);

} // namespace reradiant
