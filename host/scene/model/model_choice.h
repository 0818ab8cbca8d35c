#pragma once

#include "reradiant/scene.h"

#include <string>

namespace reradiant {

/// A `ModelUse` is the purpose for which a model is chosen. In a measurement the walk runs on the
/// host, which knows every stack. Pictures use the device's walk, which does not know every stack
/// and does not work with hero wavelengths.
enum class ModelUse { Measure, Render, RenderHero };

struct ModelChoice {
    Model model = Model::Adding; ///< never Auto
    std::string reason;          ///< one line for the user; empty for a model asked for by name
};

/// Returns why adding cannot do a material, or nothing if it can: it needs a diffuse substrate, no
/// flakes and no films on rough interfaces.
std::optional<std::string> adding_refusal(const Material& material);

/// Returns why the device's walk cannot do a material, or nothing if it can: an IOR that depends on
/// wavelength sends its wavelengths different ways, a film between dielectrics splits them
/// differently, and smooth flakes are mirrors at random places.
std::optional<std::string> device_walk_refusal(const Material& material);

/// The model that `requested` means for a material: what is named there, else what the material
/// names, else (`auto` in both) adding wherever it can do the material, since it follows every
/// interreflection in closed form. Beyond that there is no closed form that keeps the energy, and
/// the walk is taken, which is exact and slower. A picture of a bare conductor, of which
/// weidlich-wilkie is the plain reflection by its facets, or of what the device's walk cannot do,
/// is given to weidlich-wilkie; the reason says so. Input Error for adding, when named, on a
/// material that it cannot do.
ModelChoice choose_model(const Material& material, Model requested, ModelUse use);

} // namespace reradiant
