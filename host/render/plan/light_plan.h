#pragma once

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
    std::uint64_t floats = 0;             ///< that lights add to the tables, images included
    RenderFeatures features;
};

/// Returns the bits of all lights as if none of them were black, which takes no time.
RenderFeatures features_of_lights(const Scene& scene);

/// Samples the spectra of all lights at the plan's wavelengths.
LightPlan plan_lights(const Scene& scene, const WavelengthPlan& wavelengths);

} // namespace reradiant
