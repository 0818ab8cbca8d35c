#pragma once

#include "host/device/source.h"

#include <map>
#include <string>
#include <vector>

namespace reradiant {

/// `RenderFeatures` says what a scene needs of the kernels: one bit each in
/// kernels/core/features.h, and the sizes that are compiled in. Everything else is an argument of
/// the kernels.
struct RenderFeatures {
    bool fluorescence = false, dense_matrix = false, spectral_stack = false, dispersion = false;
    bool smooth = false, rough = false, deeper_lobes = false, weidlich_wilkie = false;
    bool area_lights = false, delta_lights = false, environment = false, lens = false;
    bool tabulated_reflectance = false, scattering_slabs = false, oren_nayar = false, walk = false;
    bool environment_image = false, textures = false, reflectance_image = false;
    bool scatter = false, band_variance = false;
    int chunks = 1, film_chunks = 1, lobes = 0;
    int hero = 0;           ///< wavelengths of a path's set; 0: all lanes
    int walk_layers = 1;    ///< most layers of a material that is walked through
    bool in_double = false; ///< directions, probabilities and factors in double precision

    static RenderFeatures all();
    /// All bits off but one; std::invalid_argument lists the names when there is none such.
    static RenderFeatures only(const std::string& name);
    KernelDefines defines() const;
    /// Name to on/off, for the statistics.
    std::map<std::string, bool> listed() const;
    /// A line for every bit that is off, and why.
    std::vector<std::string> left_out() const;
};

} // namespace reradiant
