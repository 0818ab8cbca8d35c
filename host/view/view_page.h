#pragma once

#include "host/spectral/colour/lamp.h"
#include "host/view/material_data.h"

#include <string>
#include <vector>

namespace reradiant {

/// A page to turn materials on: one HTML file that fetches nothing and draws by WebGL 2.
struct ViewPage {
    std::string title;
    std::vector<ViewedMaterial> materials; ///< one at least
    std::vector<Lamp> lamps;               ///< in the order of the page's list, before usual ones
    bool is_gallery =
        false; ///< tiles to choose from, and no tables for sliders but the models' own
};

/// Returns the page's HTML. Names are escaped. Input Error at its place for a material that no
/// model of a page can show (viewed_models), and as `measure` has it.
std::string view_page(const ViewPage& page);

} // namespace reradiant
