#include "host/render/plan/render_features.h"

#include <fmt/core.h>

#include <stdexcept>

namespace reradiant {

namespace {

struct FeatureBit {
    const char* name;
    const char* define;
    bool RenderFeatures::*value;
    const char* why_off;
};

/// Deeper lobes of kernels that are specialised for nothing: more than most scenes have.
constexpr int generic_lobes = 4;

constexpr FeatureBit feature_bits[] = {
    {"fluorescence", "FEATURE_FLUORESCENCE", &RenderFeatures::fluorescence,
     "no substrate re-radiates"},
    {"dense_matrix", "FEATURE_DENSE_MATRIX", &RenderFeatures::dense_matrix,
     "every re-radiation matrix factors"},
    {"spectral_stack", "FEATURE_SPECTRAL_STACK", &RenderFeatures::spectral_stack,
     "no layer absorbs or disperses"},
    {"dispersion", "FEATURE_DISPERSION", &RenderFeatures::dispersion,
     "no rough interface that kernels evaluate has an IOR that depends on wavelength"},
    {"smooth", "FEATURE_SMOOTH", &RenderFeatures::smooth, "nothing smooth reflects"},
    {"rough", "FEATURE_ROUGH", &RenderFeatures::rough, "no top interface or bare metal is rough"},
    {"deeper_lobes", "FEATURE_DEEPER_LOBES", &RenderFeatures::deeper_lobes,
     "nothing under a top interface makes a highlight of its own"},
    {"weidlich_wilkie", "FEATURE_WEIDLICH_WILKIE", &RenderFeatures::weidlich_wilkie,
     "no stack with highlights of its own below the top uses the model weidlich-wilkie"},
    {"tabulated_reflectance", "FEATURE_TABULATED_REFLECTANCE",
     &RenderFeatures::tabulated_reflectance, "no rough metal, flakes or film"},
    {"scattering_slabs", "FEATURE_SCATTERING_SLABS", &RenderFeatures::scattering_slabs,
     "no slab scatters"},
    {"oren_nayar", "FEATURE_OREN_NAYAR", &RenderFeatures::oren_nayar, "no substrate is Oren-Nayar"},
    {"walk", "FEATURE_WALK", &RenderFeatures::walk, "no material uses the model walk"},
    {"area_lights", "FEATURE_AREA_LIGHTS", &RenderFeatures::area_lights,
     "no rectangle or sphere light"},
    {"delta_lights", "FEATURE_DELTA_LIGHTS", &RenderFeatures::delta_lights,
     "no point or directional light"},
    {"environment", "FEATURE_ENVIRONMENT", &RenderFeatures::environment, "no environment light"},
    {"environment_image", "FEATURE_ENVIRONMENT_IMAGE", &RenderFeatures::environment_image,
     "no environment is an image"},
    {"textures", "FEATURE_TEXTURES", &RenderFeatures::textures,
     "no material has textures or is a mixture"},
    {"reflectance_image", "FEATURE_REFLECTANCE_IMAGE", &RenderFeatures::reflectance_image,
     "no reflectance is an image"},
    {"lens", "FEATURE_LENS", &RenderFeatures::lens, "the camera is a pinhole"},
    {"scatter", "FEATURE_SCATTER", &RenderFeatures::scatter,
     "every wavelength belongs to one film band"},
    {"band_variance", "FEATURE_BAND_VARIANCE", &RenderFeatures::band_variance,
     "variance per band was not asked for"},
};

} // namespace

RenderFeatures RenderFeatures::all() {
    RenderFeatures features;
    for (const FeatureBit& bit : feature_bits)
        features.*bit.value = true;
    features.lobes = generic_lobes;
    return features;
}

RenderFeatures RenderFeatures::only(const std::string& name) {
    RenderFeatures features;
    std::string names;
    for (const FeatureBit& bit : feature_bits) {
        if (name == bit.name) {
            features.*bit.value = true;
            features.lobes = features.deeper_lobes ? generic_lobes : 0;
            return features;
        }
        names += std::string(names.empty() ? "" : ", ") + bit.name;
    }
    throw std::invalid_argument(
        fmt::format("kernels have no feature '{}'; there are {}", name, names));
}

KernelDefines RenderFeatures::defines() const {
    KernelDefines defines;
    for (const FeatureBit& bit : feature_bits)
        defines.emplace_back(bit.define, this->*bit.value ? 1 : 0);
    defines.emplace_back("CHUNKS", chunks);
    defines.emplace_back("FILM_CHUNKS", film_chunks);
    defines.emplace_back("LOBES", lobes);
    defines.emplace_back("HERO", hero);
    defines.emplace_back("WALK_LAYERS", walk_layers);
    if (in_double)
        defines.emplace_back("KERNELS_IN_DOUBLE", 1);
    return defines;
}

std::map<std::string, bool> RenderFeatures::listed() const {
    std::map<std::string, bool> list;
    for (const FeatureBit& bit : feature_bits)
        list[bit.name] = this->*bit.value;
    list["hero"] = hero > 0;
    list["double"] = in_double;
    return list;
}

std::vector<std::string> RenderFeatures::left_out() const {
    std::vector<std::string> lines;
    for (const FeatureBit& bit : feature_bits)
        if (!(this->*bit.value))
            lines.push_back(fmt::format("{}: {}", bit.name, bit.why_off));
    if (hero == 0)
        lines.push_back("hero: every path carries all wavelengths");
    if (!in_double)
        lines.push_back("double: not asked for");
    return lines;
}

} // namespace reradiant
