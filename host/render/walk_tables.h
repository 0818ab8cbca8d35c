#pragma once

#include "host/render/scene_tables.h"

namespace reradiant {

/// Appends the tables of a material that is walked through (kernels/walk.h); sets the feature bits
/// it needs. `file`: the scene's, for errors. Input Error for what device_walk_refusal names.
void append_walk_material(const Material& material, const WavelengthPlan& plan,
                          const std::string& file, SceneTables& tables);

} // namespace reradiant
