#pragma once

#include "reradiant/scene.h"
#include "reradiant/wavelength_grid.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace reradiant {

/// A material on a page, with the name that it is shown under.
struct ViewedMaterial {
    std::string name;
    Material material;
};

/// The models that a page can show a material by, the first being the one it begins with, and what
/// a reader must know about the others.
struct ViewedModels {
    std::vector<Model> models;
    std::vector<std::string> notes;
};

/// Chooses them: adding where it knows the material, and weidlich-wilkie in closed form, which
/// knows no dyes in layers. Input Error at the material's place where neither can show it, as for
/// sheets.
ViewedModels viewed_models(const Material& material);
/// True where one of them can.
bool is_shown_on_pages(const Material& material);

/// Everything that the page's script needs of a material, on the material's own bands
/// (measured_bands). Input Error as `measure` has it.
nlohmann::ordered_json material_data(const ViewedMaterial& viewed, bool with_sliders);

} // namespace reradiant
