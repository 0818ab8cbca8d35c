#pragma once

#include "kernels/core/portable.h"
#include "reradiant/stack_elements.h"

#include <vector>

namespace reradiant {

/// 0, 1 and the cosines in air between them where some medium of the stack turns from transparent
/// to totally reflecting, or where a denser one changes the path: pieces for a quadrature.
std::vector<double> breaks_in_air(std::span<const StackElement> stack);

/// Unit vector in the local frame, azimuth in radians.
kernels::Vec3 direction_at(double cos_theta, double phi);

} // namespace reradiant
