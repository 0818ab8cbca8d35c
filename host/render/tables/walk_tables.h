#pragma once

#include "host/render/tables/scene_tables.h"

namespace reradiant {

/// Appends the tables of a material that is walked through (kernels/walk/walk.h).
void append_walk_material(const Material& material, const MaterialPlan& plan,
                          const WavelengthPlan& wavelengths, SceneTables& tables);

/// Appends those of a sheet as it is seen from beneath, whose material is `above`.
void append_walked_other_side(const Material& material, const MaterialPlan& plan,
                              const WavelengthPlan& wavelengths, std::size_t above,
                              SceneTables& tables);

} // namespace reradiant
