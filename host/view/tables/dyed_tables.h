#pragma once

#include "reradiant/scene.h"
#include "reradiant/wavelength_grid.h"

#include <nlohmann/json.hpp>

namespace reradiant {

/// Light that dyes in layers and the substrate beneath them send out again, as JSON for the page's
/// script (host/view/page/dyes.js): at so many `nodes` of both cosines, over what the stack would
/// let `through` without absorption and clouds (by band and node of CosineTable), which leaves
/// functions that few nodes hold. `numbers` is (node out, node in, emission, excitation), without
/// what is above the diagonal where nothing is sent out below what excites it (`isLower`). Input
/// Error for what adding cannot do with dyes.
nlohmann::ordered_json dyed_tables(const Material& material, const WavelengthGrid& bands,
                                   int nodes);

} // namespace reradiant
