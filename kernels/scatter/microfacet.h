// Microfacet distributions of rough interfaces: blinn (V-cavities), beckmann and ggx (Smith).
// Everything is in the local frame, normal along z, isotropic.
#ifndef RERADIANT_MICROFACET_H
#define RERADIANT_MICROFACET_H

#include "kernels/core/portable.h"
#include "kernels/core/sampling.h"

#define MICROFACET_BLINN 0
#define MICROFACET_BECKMANN 1
#define MICROFACET_GGX 2

KERNELS_BEGIN

/// Density D(h) of facet normals, 1/sr, with integral D(h) h.z dh = 1; 0 for h.z <= 0. `h` has
/// unit length. alpha > 0; blinn: exponent e = 2 / alpha^2 - 2, alpha <= 1.
/// ggx: Walter et al. 2007 eq. 33; beckmann: eq. 25; blinn: Blinn 1977, normalised by
/// (e + 2) / (2 pi). All use sin^2 = x^2 + y^2: 1 - z^2 is 12 % off in single precision at
/// alpha = 1e-3, and pow(z, e) at large exponents likewise.
DEVICE_FUNCTION real microfacet_d(int distribution, real alpha, Vec3 h) {
    real sin2 = h.x * h.x + h.y * h.y;
    real cos2 = h.z * h.z;
    real a2 = alpha * alpha;
    if (h.z <= REAL(0.0))
        return REAL(0.0);
    if (distribution == MICROFACET_GGX) {
        real q = cos2 + sin2 / a2;
        return INV_PI_REAL / (a2 * q * q);
    }
    if (distribution == MICROFACET_BECKMANN) {
        real t = sin2 / (cos2 * a2);
        // exp(-t) / cos^4 is below the smallest number there; cos^4 may be 0
        if (!(t < REAL(700.0)))
            return REAL(0.0);
        return INV_PI_REAL * exp(-t) / (a2 * cos2 * cos2);
    }
    {
        real log_cos2 = sin2 < REAL(0.5) ? log1p(-sin2) : REAL(2.0) * log(h.z);
        real half_exponent = fmax(REAL(1.0) / a2 - REAL(1.0), REAL(0.0));
        return INV_PI_REAL / a2 * exp(half_exponent * log_cos2);
    }
}

/// cos_theta * Lambda(w) for w above the surface: finite up to and including grazing directions,
/// where Lambda itself is infinite. Smith's Lambda, Heitz 2014 eqs. 72 (ggx) and 66 (beckmann).
DEVICE_FUNCTION real microfacet_lambda_cos(int distribution, real alpha, Vec3 w) {
    real s = alpha * sqrt(w.x * w.x + w.y * w.y);
    if (s <= REAL(0.0))
        return REAL(0.0);
    if (distribution == MICROFACET_BECKMANN) {
        real a = w.z / s;
        // 1 / sqrt(pi); the difference is positive but rounds below zero where it is negligible
        real d = s * exp(-a * a) * REAL(0.56418958354775628695) - w.z * erfc(a);
        return REAL(0.5) * fmax(d, REAL(0.0));
    }
    return REAL(0.5) * s * s / (w.z + sqrt(w.z * w.z + s * s));
}

/// Smith's Lambda(w), beckmann and ggx, w.z > 0 (Heitz 2014 eqs. 66, 72).
DEVICE_FUNCTION real microfacet_lambda(int distribution, real alpha, Vec3 w) {
    return microfacet_lambda_cos(distribution, alpha, w) / w.z;
}

/// G2(wi, wo, h) / (cos_i cos_o), finite unless both directions graze; both above the surface.
DEVICE_FUNCTION real microfacet_g2_over_cosines(int distribution, real alpha, Vec3 wi, Vec3 wo,
                                                Vec3 h) {
    real cc = wi.z * wo.z;
    if (distribution == MICROFACET_BLINN) {
        real shadow_i = REAL(2.0) * h.z / (vec3_dot(wi, h) * wo.z);
        real shadow_o = REAL(2.0) * h.z / (vec3_dot(wo, h) * wi.z);
        return fmin(REAL(1.0) / cc, fmin(shadow_i, shadow_o));
    }
    return REAL(1.0) / (cc + wo.z * microfacet_lambda_cos(distribution, alpha, wi) +
                        wi.z * microfacet_lambda_cos(distribution, alpha, wo));
}

/// Share of facets with normal h that see both directions, wi and wo above the surface. ggx,
/// beckmann: Smith, height-correlated, 1 / (1 + Lambda_i + Lambda_o) (Heitz 2014 eq. 99); blinn:
/// V-cavities, min(1, 2 h.z o.z / (o.h), 2 h.z i.z / (i.h)) (Cook and Torrance 1982 eq. 3).
DEVICE_FUNCTION real microfacet_g2(int distribution, real alpha, Vec3 wi, Vec3 wo, Vec3 h) {
    if (distribution == MICROFACET_BLINN) {
        real i = REAL(2.0) * h.z * wi.z / vec3_dot(wi, h);
        real o = REAL(2.0) * h.z * wo.z / vec3_dot(wo, h);
        return fmin(REAL(1.0), fmin(i, o));
    }
    return REAL(1.0) / (REAL(1.0) + microfacet_lambda(distribution, alpha, wi) +
                        microfacet_lambda(distribution, alpha, wo));
}

/// Reflection lobe D(h) G2 / (4 cos_i cos_o), 1/sr, WITHOUT Fresnel and without cosine; 0 unless
/// both directions are above the surface (Torrance and Sparrow 1967; Walter et al. 2007 eq. 20).
DEVICE_FUNCTION real microfacet_reflection(int distribution, real alpha, Vec3 wi, Vec3 wo) {
    Vec3 h;
    if (wi.z <= REAL(0.0) || wo.z <= REAL(0.0))
        return REAL(0.0);
    h = vec3_normalise(vec3_add(wi, wo));
    return REAL(0.25) * microfacet_d(distribution, alpha, h) *
           microfacet_g2_over_cosines(distribution, alpha, wi, wo, h);
}

/// microfacet_reflection times cos_i, formed without dividing by it, so that it goes to 0 with
/// cos_i smoothly.
DEVICE_FUNCTION real microfacet_reflection_cos(int distribution, real alpha, Vec3 wi, Vec3 wo) {
    return microfacet_reflection(distribution, alpha, wi, wo) * fmax(wi.z, REAL(0.0));
}

/// Inverse error function for |x| < 1: Giles 2010, "Approximating the erfinv function", table 5,
/// relative error below 4e-7. Arguments at +-1 are moved inwards by one part in 1e7.
DEVICE_FUNCTION real microfacet_erfinv(real x) {
    real w, p;
    x = fmin(fmax(x, REAL(-0.9999999)), REAL(0.9999999));
    w = -log((REAL(1.0) - x) * (REAL(1.0) + x));
    if (w < REAL(5.0)) {
        w = w - REAL(2.5);
        p = REAL(2.81022636e-08);
        p = REAL(3.43273939e-07) + p * w;
        p = REAL(-3.5233877e-06) + p * w;
        p = REAL(-4.39150654e-06) + p * w;
        p = REAL(0.00021858087) + p * w;
        p = REAL(-0.00125372503) + p * w;
        p = REAL(-0.00417768164) + p * w;
        p = REAL(0.246640727) + p * w;
        p = REAL(1.50140941) + p * w;
    } else {
        w = sqrt(w) - REAL(3.0);
        p = REAL(-0.000200214257);
        p = REAL(0.000100950558) + p * w;
        p = REAL(0.00134934322) + p * w;
        p = REAL(-0.00367342844) + p * w;
        p = REAL(0.00573950773) + p * w;
        p = REAL(-0.0076224613) + p * w;
        p = REAL(0.00943887047) + p * w;
        p = REAL(1.00167406) + p * w;
        p = REAL(2.83297682) + p * w;
    }
    return p * x;
}

/// Slope of a visible facet of a Beckmann surface of alpha 1 along the viewer's azimuth, for a
/// viewer at (sin_theta, cos_theta): density proportional to (cos - x sin) exp(-x^2) for
/// x < cot theta (Heitz and d'Eon 2014, supplement 1), by safeguarded Newton steps on its
/// distribution function. cos_theta may be negative.
DEVICE_FUNCTION real microfacet_beckmann_slope(real cos_theta, real sin_theta, real u) {
    real low = REAL(-6.0);
    real high = cos_theta < REAL(6.0) * sin_theta ? cos_theta / sin_theta : REAL(6.0);
    real half_sqrt_pi = REAL(0.88622692545275801365);
    real target, x;
    int step;
    if (high <= low)
        return high;
    u = fmin(fmax(u, REAL(1e-7)), REAL(0.9999999));
    target =
        u * (cos_theta * half_sqrt_pi * erfc(-high) + REAL(0.5) * sin_theta * exp(-high * high));
    // exact at normal and at grazing view
    x = fabs(cos_theta) * microfacet_erfinv(REAL(2.0) * u - REAL(1.0)) -
        (REAL(1.0) - fabs(cos_theta)) * sqrt(-log(u));
    for (step = 0; step < 24; ++step) {
        real e, value, slope, next;
        if (!(x > low && x < high))
            x = REAL(0.5) * (low + high);
        e = exp(-x * x);
        value = cos_theta * half_sqrt_pi * erfc(-x) + REAL(0.5) * sin_theta * e - target;
        slope = e * (cos_theta - x * sin_theta);
        if (value > REAL(0.0))
            high = x;
        else
            low = x;
        next = x - value / slope;
        if (fabs(next - x) < REAL(1e-6))
            break;
        x = next;
    }
    return x;
}

/// GGX: Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps", listing 3.
DEVICE_FUNCTION Vec3 microfacet_sample_ggx(real alpha, Vec3 wo, real u1, real u2) {
    Vec3 v = vec3_normalise(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    real z = REAL(1.0) - u1 * (REAL(1.0) + v.z);
    real sin_z = sqrt(fmax((REAL(1.0) - z) * (REAL(1.0) + z), REAL(0.0)));
    Vec3 around = sampling_circle(u2);
    Vec3 n = vec3(sin_z * around.x + v.x, sin_z * around.y + v.y, z + v.z);
    return vec3_normalise(vec3(alpha * n.x, alpha * n.y, fmax(n.z, REAL(1e-30))));
}

/// Beckmann: Heitz and d'Eon 2014, in the slopes of the stretched surface.
DEVICE_FUNCTION Vec3 microfacet_sample_beckmann(real alpha, Vec3 wo, real u1, real u2) {
    Vec3 v = vec3_normalise(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    real sin_theta = sqrt(v.x * v.x + v.y * v.y);
    real along = microfacet_beckmann_slope(v.z, sin_theta, u1);
    real across = microfacet_erfinv(REAL(2.0) * u2 - REAL(1.0));
    real cos_phi = sin_theta > REAL(0.0) ? v.x / sin_theta : REAL(1.0);
    real sin_phi = sin_theta > REAL(0.0) ? v.y / sin_theta : REAL(0.0);
    real x = cos_phi * along - sin_phi * across;
    real y = sin_phi * along + cos_phi * across;
    return vec3_normalise(vec3(-alpha * x, -alpha * y, REAL(1.0)));
}

/// Half vector for a direction wo, from two uniform numbers in [0, 1). ggx, beckmann: from the
/// normals visible to wo (wo may point below the surface too, for walks between facets); blinn:
/// from D(h) h.z, whose weights in reflection are bounded by 2 thanks to the V-cavity's G.
DEVICE_FUNCTION Vec3 microfacet_sample(int distribution, real alpha, Vec3 wo, real u1, real u2) {
    if (distribution == MICROFACET_GGX)
        return microfacet_sample_ggx(alpha, wo, u1, u2);
    if (distribution == MICROFACET_BECKMANN)
        return microfacet_sample_beckmann(alpha, wo, u1, u2);
    {
        // h.z^(e + 2) = 1 - u1 and e + 2 = 2 / alpha^2
        real log_cos2 = alpha * alpha * log1p(-fmin(u1, REAL(0.99999994)));
        real sin_h = sqrt(-expm1(log_cos2));
        Vec3 around = sampling_circle(u2);
        return vec3(sin_h * around.x, sin_h * around.y, exp(REAL(0.5) * log_cos2));
    }
}

/// Density of microfacet_sample over half vectors, 1/sr; wo above the surface. ggx, beckmann:
/// G1(wo) (wo.h) D(h) / wo.z (Heitz and d'Eon 2014 eq. 2), 0 for facets turned away.
DEVICE_FUNCTION real microfacet_pdf(int distribution, real alpha, Vec3 wo, Vec3 h) {
    real d = microfacet_d(distribution, alpha, h);
    if (distribution == MICROFACET_BLINN)
        return d * fmax(h.z, REAL(0.0));
    return d * fmax(vec3_dot(wo, h), REAL(0.0)) /
           (wo.z + microfacet_lambda_cos(distribution, alpha, wo));
}

KERNELS_END

#endif
