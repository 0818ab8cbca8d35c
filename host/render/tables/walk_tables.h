#pragma once

#include "host/render/tables/scene_tables.h"

namespace reradiant {

/// Appends the tables of a material that is walked through (kernels/walk/walk.h).
void append_walk_material(const Material& material, const MaterialPlan& plan,
                          const WavelengthPlan& wavelengths, SceneTables& tables);

} // namespace reradiant
