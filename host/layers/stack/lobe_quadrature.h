#pragma once

#include "kernels/core/portable.h"

#include <functional>

namespace reradiant {

/// Integral of f(wo) cos(wo) over the hemisphere for an f that is symmetric about the plane of
/// incidence and may peak where the half vector of wi and wo is the normal, as sharply as at a
/// millionth of a radian. Gauss-Legendre over the half vector: rings that halve towards the normal,
/// each over the azimuths whose wo lies above the surface, so that nothing is cut within a piece.
double integrate_about_mirror(const kernels::Vec3& wi,
                              const std::function<double(const kernels::Vec3& wo)>& f);

} // namespace reradiant
