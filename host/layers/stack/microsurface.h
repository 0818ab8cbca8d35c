#pragma once

#include "kernels/scatter/microfacet.h"

#include <algorithm>
#include <cmath>

/// Heights on a Smith microsurface (Heitz, Hanika, d'Eon and Dachsbacher 2016, sections 4 to 6).
/// Only the distribution function C of heights matters, so C itself is the height: 1 at the top
/// as seen from the medium whose frame is used, where directions with z > 0 point away.
namespace reradiant::microsurface {

inline double lambda(int distribution, double alpha, const kernels::Vec3& w) {
    // at grazing Lambda is infinite; the bound keeps 0 * inf out and changes nothing visible
    return kernels::microfacet_lambda_cos(distribution, alpha, w) / std::max(w.z, 1e-12);
}

inline kernels::Vec3 negated(const kernels::Vec3& v) {
    return kernels::vec3(-v.x, -v.y, -v.z);
}

/// Probability that a ray from `height` in direction w leaves the surface.
inline double escape(int distribution, double alpha, const kernels::Vec3& w, double height) {
    return w.z > 0.0 ? std::exp(lambda(distribution, alpha, w) * std::log(height)) : 0.0;
}

/// Height of the next facet on a ray from `height` that meets one (eq. 19, conditional), from a
/// uniform number. Inside (0, 1).
inline double next_height(int distribution, double alpha, const kernels::Vec3& w, double height,
                          double u) {
    if (w.z > 0.0) {
        const double l = std::max(lambda(distribution, alpha, w), 1e-12);
        const double hit = -std::expm1(l * std::log(height));
        height = std::min(height * std::exp(-std::log1p(-u * hit) / l), 1.0);
    } else {
        height *= std::pow(1.0 - u, 1.0 / (1.0 + lambda(distribution, alpha, negated(w))));
    }
    return std::clamp(height, 1e-300, 1.0 - 1e-16);
}

} // namespace reradiant::microsurface
