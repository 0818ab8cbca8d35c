#pragma once

#include "reradiant/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace reradiant {

/// Cuts a polygon in space (at least three corners, finite) into triangles: corner numbers, three a
/// triangle, turning the way the polygon does. A convex one becomes the fan of corner 0, others
/// lose ears (Meisters 1975). Seen along the polygon's mean normal (Newell) the triangles do not
/// overlap and have its area to 1e-6; for corners that do not lie in a plane this shadow is what
/// the cut is made by. Holes may be joined to the outline by an edge that is walked both ways.
/// Corners may repeat, lie on a line, or touch other edges. Empty when all corners lie on a line.
/// Throws std::invalid_argument (a sentence without a subject) for a polygon that crosses itself,
/// or has so many corners that its cut would take more than about a second.
std::vector<std::uint32_t> triangulate_polygon(std::span<const Vector3> corners);

} // namespace reradiant
