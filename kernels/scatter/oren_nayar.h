// Rough diffuse surfaces after Oren and Nayar 1994, in their qualitative form.
#ifndef RERADIANT_OREN_NAYAR_H
#define RERADIANT_OREN_NAYAR_H

#include "kernels/core/portable.h"

KERNELS_BEGIN

/// A and B of Oren and Nayar 1994 eq. 30, sigma >= 0 in radians. A = 1 and B = 0 for sigma 0.
DEVICE_FUNCTION real oren_nayar_a(real sigma) {
    real s2 = sigma * sigma;
    return REAL(1.0) - REAL(0.5) * s2 / (s2 + REAL(0.33));
}
DEVICE_FUNCTION real oren_nayar_b(real sigma) {
    real s2 = sigma * sigma;
    return REAL(0.45) * s2 / (s2 + REAL(0.09));
}

/// f / rho, 1/sr, no cosine: (A + B max(0, cos(phi_i - phi_o)) sin(alpha) tan(beta)) / pi, alpha
/// the larger and beta the smaller angle from the normal. Reciprocal; 1 / pi for sigma 0; 0 unless
/// both directions are above the surface.
DEVICE_FUNCTION real oren_nayar_value(real sigma, Vec3 wi, Vec3 wo) {
    // sin_i sin_o cos(phi_i - phi_o), to be divided by the cosine of the smaller angle
    real along = wi.x * wo.x + wi.y * wo.y;
    real shape;
    if (!(wi.z > REAL(0.0)) || !(wo.z > REAL(0.0)))
        return REAL(0.0);
    shape = along > REAL(0.0) ? along / fmax(wi.z, wo.z) : REAL(0.0);
    return INV_PI_REAL * (oren_nayar_a(sigma) + oren_nayar_b(sigma) * shape);
}

/// Directional-hemispherical reflectance over rho for light at cos_theta: the integral of
/// oren_nayar_value cos over the other direction, in closed form,
/// A + B (sin (theta - sin cos) / 2 + tan (1 - sin^3) / 3) 2 / pi. For 0 < sigma < 0.33 it exceeds
/// 1 beyond 65 degrees, by up to 0.0152 (sigma 0.2, grazing): so much energy the qualitative form
/// creates.
DEVICE_FUNCTION real oren_nayar_albedo(real sigma, real cos_theta) {
    real c = fmin(fmax(cos_theta, REAL(0.0)), REAL(1.0));
    real s = sqrt((REAL(1.0) - c) * (REAL(1.0) + c));
    real theta = atan2(s, c);
    // tan (1 - sin^3) without its 0 / 0 at grazing
    real rising = s * c * (REAL(1.0) + s + s * s) / (REAL(1.0) + s);
    real shape = REAL(0.5) * s * (theta - s * c) + rising / REAL(3.0);
    return oren_nayar_a(sigma) + oren_nayar_b(sigma) * (REAL(2.0) * INV_PI_REAL) * shape;
}

/// Reflectance over rho for diffuse light: 2 integral oren_nayar_albedo c dc =
/// A + B (2/3 - 64 / (45 pi)), below 1 for every sigma > 0.
DEVICE_FUNCTION real oren_nayar_mean_albedo(real sigma) {
    return oren_nayar_a(sigma) +
           oren_nayar_b(sigma) * (REAL(2.0) / REAL(3.0) - REAL(64.0) / REAL(45.0) * INV_PI_REAL);
}

KERNELS_END

#endif
