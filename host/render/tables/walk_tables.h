#pragma once

#include "host/render/tables/scene_tables.h"

namespace reradiant {

/// Appends the tables of a material that is walked through (kernels/walk/walk.h); sets the feature
/// bits it needs. Input Error at the material for what device_walk_refusal names.
void append_walk_material(const Material& material, const WavelengthPlan& plan,
                          SceneTables& tables);

} // namespace reradiant
