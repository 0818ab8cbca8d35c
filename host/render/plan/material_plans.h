#pragma once

#include "host/render/plan/material_plan.h"

#include <vector>

namespace reradiant {

/// Plans a scene's materials on all cores, each by the choice that already stands in its place of
/// `plans`. The Error of the first material that plan_material refuses.
void plan_materials(const Scene& scene, const WavelengthPlan& wavelengths,
                    std::vector<MaterialPlan>& plans);

} // namespace reradiant
