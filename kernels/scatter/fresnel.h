// Unpolarised Fresnel equations of smooth interfaces: dielectrics and conductors.
#ifndef RERADIANT_FRESNEL_H
#define RERADIANT_FRESNEL_H

#include "kernels/core/portable.h"

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
    if (eta == REAL(1.0))
        return REAL(0.0);
    if (g2 <= REAL(0.0))
        return REAL(1.0);
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
    if (g2 <= REAL(0.0))
        return REAL(0.0);
    c = sqrt(g2) / eta;
    return c < REAL(1.0) ? c : REAL(1.0);
}

/// Direction w (w.z >= 0) of one side of a smooth interface refracted to the other, as seen from
/// there on the same side of the normal; z = 0 at and beyond the critical angle.
DEVICE_FUNCTION Vec3 fresnel_refracted(Vec3 w, real eta) {
    return vec3(w.x / eta, w.y / eta, fresnel_cos_transmitted(w.z, eta));
}

/// Reflectance (unit 1) of an opaque conductor for unpolarised light: IOR eta + i k relative to the
/// medium of incidence, cos_i >= 0. k == 0 is a dielectric of IOR ratio eta. Born and Wolf, 14.2,
/// with q = a + i b, q^2 = (eta + i k)^2 - sin^2: |r_s|^2 = ((a - c)^2 + b^2) / ((a + c)^2 + b^2)
/// and |r_p / r_s|^2 = ((a c - s^2)^2 + (b c)^2) / ((a c + s^2)^2 + (b c)^2). The smaller of a and
/// b follows from a b = eta k, and a - c from a^2 - c^2, so that single precision keeps its digits
/// for strong and for vanishing absorption.
DEVICE_FUNCTION real fresnel_conductor(real cos_i, real eta, real k) {
    real excess = (eta - REAL(1.0)) * (eta + REAL(1.0));
    real cos2 = cos_i * cos_i;
    real sin2 = (REAL(1.0) - cos_i) * (REAL(1.0) + cos_i);
    real q2 = excess - k * k + cos2;
    real product = eta * k;
    real modulus = sqrt(q2 * q2 + REAL(4.0) * product * product);
    real a, b, difference, s, p, bc;
    if (!(product > REAL(0.0)))
        return k > REAL(0.0) ? REAL(1.0) : fresnel_dielectric(cos_i, eta);
    if (q2 > REAL(0.0)) {
        a = sqrt(REAL(0.5) * (modulus + q2));
        b = product / a;
    } else {
        b = sqrt(REAL(0.5) * (modulus - q2));
        a = product / b;
    }
    difference = (excess - k * k + b * b) / (a + cos_i);
    s = (difference * difference + b * b) / ((a + cos_i) * (a + cos_i) + b * b);
    bc = b * cos_i;
    p = ((a * cos_i - sin2) * (a * cos_i - sin2) + bc * bc) /
        ((a * cos_i + sin2) * (a * cos_i + sin2) + bc * bc);
    s = REAL(0.5) * s * (REAL(1.0) + p);
    return s < REAL(1.0) ? s : REAL(1.0);
}

KERNELS_END

#endif
