#pragma once

#include "host/render/plan/light_layer_plan.h"
#include "host/render/plan/render_features.h"
#include "kernels/core/shared.h"
#include "reradiant/wavelength_plan.h"

#include <cstdint>
#include <vector>

namespace reradiant {

/// A `LightSpectrum` is what one light sends.
struct LightSpectrum {
    /// [phase][lane]; three of them, one for each colour, for an image; empty for one that is
    /// black.
    std::vector<float> lanes;
    double mean = 0.0; ///< over lanes and directions
};

/// A `LightPlan` says what the lights of a render send, and what they need.
struct LightPlan {
    std::vector<LightSpectrum> lights;    ///< as in Scene::lights
    std::uint32_t environment = NO_INDEX; ///< the first light of those constant environments that
                                          ///< shine; each holds the sum of all
    std::uint64_t floats = 0; ///< that lights and layers add to the tables, images included
    RenderFeatures features;
    std::vector<LightLayerPlan> layers; ///< empty where they are not asked for

    /// Floats of a spectrum that is dark, for layers: as long as that of any light.
    std::size_t dark_floats() const;
};

/// Returns the bits of all lights as if none of them were black, which takes no time.
RenderFeatures features_of_lights(const Scene& scene);

/// Samples a spectrum at the plan's wavelengths.
LightSpectrum plain_spectrum(const Spectrum& spectrum, const WavelengthPlan& wavelengths);

/// Samples the spectra of all lights at the plan's wavelengths; with layers, what of them each
/// layer is lit by, too.
LightPlan plan_lights(const Scene& scene, const WavelengthPlan& wavelengths, bool with_layers);

} // namespace reradiant
