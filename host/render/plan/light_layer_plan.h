#pragma once

#include "reradiant/scene.h"
#include "reradiant/spectral_image.h"
#include "reradiant/wavelength_plan.h"

#include <cstdint>
#include <string>
#include <vector>

namespace reradiant {

struct LightPlan;

/// A `LightLayerPlan` is one layer of a render (RenderOptions::light_groups) and what of each
/// light's spectrum it is lit by.
struct LightLayerPlan {
    LightLayer layer; ///< without values
    /// By light of the scene: its lanes as in LightSpectrum, 0 where they are not the layer's;
    /// empty where none is.
    std::vector<std::vector<float>> spectra;
};

/// Returns the group of every light of a scene: its name, or "TYPE:NUMBER" by its place.
std::vector<std::string> light_group_names(const Scene& scene);

/// Layers that a render has at most.
std::uint64_t most_light_layers(const Scene& scene);

/// Plans the layers of all groups; those that no light reaches are left out.
std::vector<LightLayerPlan> plan_light_layers(const Scene& scene, const WavelengthPlan& wavelengths,
                                              const LightPlan& lights);

} // namespace reradiant
