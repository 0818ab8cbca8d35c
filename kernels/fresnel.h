// Unpolarised Fresnel equations of a smooth dielectric interface.
#ifndef RERADIANT_FRESNEL_H
#define RERADIANT_FRESNEL_H

#include "kernels/portable.h"

KERNELS_BEGIN

/// Reflectance (unit 1) of an interface for unpolarised light; cos_i >= 0 is the cosine on the
/// incident side, eta = n_transmitted / n_incident > 0. Exactly 1 at and beyond the critical
/// angle, exactly 0 for eta == 1.
/// Born and Wolf, Principles of Optics, 1.5.2 eqs. 20-21, written by differences: with
/// g = eta cos_t both amplitudes carry the factor eta^2 - 1 = (eta - 1)(eta + 1), which keeps
/// single precision exact to a few ULP where eta is near 1 (the usual form is 14 % off at
/// eta - 1 = 1e-6).
DEVICE_FUNCTION real fresnel_dielectric(real cos_i, real eta) {
    real excess = (eta - REAL(1.0)) * (eta + REAL(1.0));
    real g2 = excess + cos_i * cos_i;
    real g, s, p, r;
    if (eta == REAL(1.0)) {
        return REAL(0.0);
    }
    if (g2 <= REAL(0.0)) {
        return REAL(1.0);
    }
    g = sqrt(g2);
    s = cos_i + g;
    p = eta * eta * cos_i + g;
    s = excess / (s * s);
    p = excess * ((excess + REAL(2.0)) * cos_i * cos_i - REAL(1.0)) / (p * p);
    r = REAL(0.5) * (s * s + p * p);
    return r < REAL(1.0) ? r : REAL(1.0);
}

/// Cosine (>= 0) of the refracted direction for cosine cos_i on the incident side and
/// eta = n_transmitted / n_incident; 0 at and beyond the critical angle. Snell's law as
/// sqrt(eta^2 - 1 + cos_i^2) / eta: from the air side inwards nothing cancels.
DEVICE_FUNCTION real fresnel_cos_transmitted(real cos_i, real eta) {
    real g2 = (eta - REAL(1.0)) * (eta + REAL(1.0)) + cos_i * cos_i;
    real c;
    if (g2 <= REAL(0.0)) {
        return REAL(0.0);
    }
    c = sqrt(g2) / eta;
    return c < REAL(1.0) ? c : REAL(1.0);
}

KERNELS_END

#endif
