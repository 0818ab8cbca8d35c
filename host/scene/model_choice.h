#pragma once

#include "host/scene/scene.h"

#include <string>

namespace reradiant {

/// What a material is looked at for: a measurement can wait for the truth, a picture wants speed.
enum class ModelUse { Measure, Render };

struct ModelChoice {
    Model model = Model::Adding; ///< never Auto
    std::string reason;          ///< one line for the user; empty for a model asked for by name
};

/// Why adding cannot do a material, or nothing: it needs a diffuse substrate, no flakes and no
/// films on rough interfaces.
std::optional<std::string> adding_refusal(const Material& material);

/// The model that `requested` means for a material: what is named there, else what the material
/// names, else (`auto` in both) adding wherever it can do the material, since it follows every
/// interreflection in closed form. Beyond that there is no closed form that keeps the energy:
/// `measure` takes the walk, which is exact and slow, `render` takes weidlich-wilkie, which is fast
/// and approximate, and the reason says that walk is the truth. Input Error for adding, when named,
/// on a material that it cannot do.
ModelChoice choose_model(const Material& material, Model requested, ModelUse use);

} // namespace reradiant
