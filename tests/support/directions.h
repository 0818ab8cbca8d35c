#pragma once

#include "kernels/core/portable.h"

#include <cmath>
#include <numbers>

namespace reradiant::test {

inline double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

/// Unit vector in a surface's frame (z = normal) by its angle to the normal and its azimuth.
inline kernels::Vec3 direction_deg(double theta_deg, double phi_deg = 0.0) {
    const double t = radians(theta_deg), p = radians(phi_deg);
    return kernels::vec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
}

} // namespace reradiant::test
