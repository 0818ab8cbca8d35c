#pragma once

#include "reradiant/scene.h"

#include <optional>
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

/// Returns why adding cannot do a material, or nothing if it can: it needs a diffuse substrate or
/// none, no flakes, no films on rough interfaces, and beneath dyes a Lambertian substrate.
std::optional<std::string> adding_refusal(const Material& material);

/// Returns why weidlich-wilkie cannot do a material, or nothing if it can: it follows no light
/// between the slabs, and so has neither dyes in them nor sheets.
std::optional<std::string> weidlich_wilkie_refusal(const Material& material);

/// A reason why a model cannot do a material, and what to use instead.
struct ModelRefusal {
    std::string reason, remedy;
};
/// Returns the refusal of a model that is named for a material; nothing for auto and the walk.
std::optional<ModelRefusal> model_refusal(const Material& material, Model model);

/// Returns why the device's walk cannot do a material, or nothing if it can: an IOR that depends on
/// wavelength sends its wavelengths different ways, a film between dielectrics splits them
/// differently, and smooth flakes are mirrors at random places.
std::optional<std::string> device_walk_refusal(const Material& material);

/// The model that `requested` means for a material: what is named there, else what the material
/// names, else (`auto` in both) adding wherever it can do the material, since it follows every
/// interreflection in closed form. Beyond that there is no closed form that keeps the energy, and
/// the walk is taken, which is exact and slower. A picture of a bare conductor, of which
/// weidlich-wilkie is the plain reflection by its facets, or of what the device's walk cannot do,
/// is given to weidlich-wilkie; the reason says so. Input Error for a model, when named, on a
/// material that it cannot do, for pictures of sheets, and for those of dyes in layers by the walk.
ModelChoice choose_model(const Material& material, Model requested, ModelUse use);

} // namespace reradiant
