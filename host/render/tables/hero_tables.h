#pragma once

#include "host/render/tables/scene_tables.h"

namespace reradiant {

/// Numbers of a path's set in memory: `hero` rounded up to a vector's width (kernels/stack/hero.h).
constexpr int hero_width(int hero) {
    return hero > 8 ? 16 : hero > 4 ? 8 : 4;
}

/// Appends to every material that re-radiates the probabilities with which `hero` samples an
/// excitation, emission given, [phase][emission lane][excitation lane], cumulative, and sets
/// MaterialRecord::shift. After materials and lights. No material may be walked through.
void append_hero(const WavelengthPlan& plan, SceneTables& tables);

} // namespace reradiant
