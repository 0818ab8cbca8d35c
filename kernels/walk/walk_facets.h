// One facet of a rough surface, as a random walk meets it: visible area, directions, and the
// density of what the facet sends into a given direction (Heitz, Hanika, d'Eon and Dachsbacher
// 2016; refraction after Walter et al. 2007).
//
// All formulas of the walk at rough surfaces stand in this header, in walk_microsurface.h and in
// walk_cavities.h, as pure functions of one step each. The loops over the steps are their callers':
// those of the device (walk_interface.h, walk_conductor.h), of the host's walk
// (host/layers/walk/walk_surface.cpp) and of its operators (host/layers/rough). They differ in what
// they record, in where random numbers come from and in how much a facet reflects (Fresnel, a film,
// a conductor), which is therefore an argument of the densities.
//
// Frames: directions of one medium have z > 0 pointing away from the surface. v points to where the
// walk came from, w to where it goes. What passes a facet is given in the frame of v too, so that
// its z is negative where it leaves; each caller turns it into the frame of the medium beyond.
#ifndef RERADIANT_WALK_FACETS_H
#define RERADIANT_WALK_FACETS_H

#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/microfacet.h"

KERNELS_BEGIN

/// Least cosine in Lambda, least Lambda that is divided by, and the heights that are told from the
/// surface's bottom and top: as far as single precision goes, or, for the host, double.
#if defined(__OPENCL_VERSION__) || defined(KERNELS_FOR_DEVICE)
#define WALK_LEAST_COSINE REAL(1e-6)
#define WALK_LEAST_LAMBDA REAL(1e-6)
#define WALK_LEAST_HEIGHT REAL(1e-30)
#define WALK_MOST_HEIGHT REAL(0.99999994)
#else
#define WALK_LEAST_COSINE REAL(1e-12)
#define WALK_LEAST_LAMBDA REAL(1e-12)
#define WALK_LEAST_HEIGHT REAL(1e-300)
#define WALK_MOST_HEIGHT (REAL(1.0) - REAL(1e-16))
#endif

/// Tables of the walk hold floats on the device and doubles on the host.
#ifdef __OPENCL_VERSION__
typedef __global const shared_float* WalkTable;
#else
typedef const double* WalkTable;
#endif

/// A surface seen from one of its media. A mirror reflects everything: what a conductor keeps
/// depends on wavelength and is applied elsewhere.
typedef struct {
    int distribution;
    real alpha; ///< 0: smooth
    real eta;   ///< IOR beyond over IOR on this side
    int multiple;
    int is_mirror;
    WalkTable cavities; ///< walk_cavities.h; of blinn, multiple
} WalkSurface;

DEVICE_FUNCTION WalkSurface walk_from_beyond(WalkSurface surface) {
    surface.eta = REAL(1.0) / surface.eta;
    return surface;
}

DEVICE_FUNCTION real walk_reflectance(WalkSurface surface, real cos_i) {
    return surface.is_mirror ? REAL(1.0) : fresnel_dielectric(cos_i, surface.eta);
}

DEVICE_FUNCTION Vec3 walk_mirrored(Vec3 v) {
    return vec3(v.x, v.y, -v.z);
}

/// Smith's Lambda of a direction that leaves the surface; bounded, so that grazing directions,
/// where it is infinite, make no 0 * inf.
DEVICE_FUNCTION real walk_lambda(WalkSurface surface, Vec3 w) {
    return microfacet_lambda_cos(surface.distribution, surface.alpha, w) /
           fmax(w.z, WALK_LEAST_COSINE);
}

/// Area of the facets that v sees over the surface's own: v.z (1 + Lambda(v)), also for v below
/// the horizon, where the sum cancels and is formed otherwise (ggx; beckmann meets such views only
/// a few alpha below, where enough digits are left).
DEVICE_FUNCTION real walk_visible_area(WalkSurface surface, Vec3 v) {
    const real s = surface.alpha * sqrt(v.x * v.x + v.y * v.y);
    if (v.z < REAL(0.0) && surface.distribution == MICROFACET_GGX)
        return REAL(0.5) * s * s / (sqrt(v.z * v.z + s * s) - v.z);
    if (v.z < REAL(0.0)) {
        const real a = v.z / s;
        // 1 / sqrt(pi)
        return REAL(0.5) *
               fmax(s * exp(-a * a) * REAL(0.56418958354775628695) + v.z * erfc(-a), REAL(0.0));
    }
    return v.z + microfacet_lambda_cos(surface.distribution, surface.alpha, v);
}

DEVICE_FUNCTION Vec3 walk_reflected(Vec3 v, Vec3 h) {
    return vec3_sub(vec3_scale(h, REAL(2.0) * vec3_dot(v, h)), v);
}

/// Refracted at a facet.
DEVICE_FUNCTION Vec3 walk_refracted(Vec3 v, Vec3 h, real eta) {
    const real cos_i = vec3_dot(v, h);
    const real along = cos_i / eta - fresnel_cos_transmitted(cos_i, eta);
    return vec3_sub(vec3_scale(h, along), vec3_scale(v, REAL(1.0) / eta));
}

/// Half vector of a reflection from v into w; w must not be -v.
DEVICE_FUNCTION Vec3 walk_half_reflected(Vec3 v, Vec3 w) {
    return vec3_normalise(vec3_add(v, w));
}

/// A `WalkRefraction` holds what a refraction from v into w needs: the normal h of the facet that
/// does it, the cosines at the facet on both sides, and the Jacobian |dh/dw| = eta^2 |w.h| / (v.h +
/// eta w.h)^2 (Walter et al. 2007 eq. 17), 0 when no facet does it.
typedef struct {
    Vec3 h;
    real cos_i, cos_t, jacobian;
} WalkRefraction;

DEVICE_FUNCTION WalkRefraction walk_refraction(WalkSurface surface, Vec3 v, Vec3 w) {
    Vec3 h = vec3_add(v, vec3_scale(w, surface.eta));
    WalkRefraction r;
    real denominator;
    r.h = vec3(REAL(0.0), REAL(0.0), REAL(1.0));
    r.cos_i = r.cos_t = r.jacobian = REAL(0.0);
    if (!(vec3_dot(h, h) > REAL(0.0)))
        return r;
    h = vec3_normalise(h);
    r.h = h.z < REAL(0.0) ? vec3_scale(h, REAL(-1.0)) : h;
    r.cos_i = vec3_dot(v, r.h);
    r.cos_t = -vec3_dot(w, r.h);
    denominator = r.cos_i - surface.eta * r.cos_t;
    if (r.cos_i > REAL(0.0) && r.cos_t > REAL(0.0) && denominator != REAL(0.0))
        r.jacobian = square(surface.eta / denominator) * r.cos_t;
    return r;
}

/// Density, 1/sr, of the light that facets visible from v reflect by the half vector h, which
/// reflect the share `reflectance` of what they get; shadowing left out.
DEVICE_FUNCTION real walk_reflection_density(WalkSurface surface, Vec3 v, Vec3 h,
                                             real reflectance) {
    const real area = walk_visible_area(surface, v);
    if (!(area > REAL(0.0)) || !(vec3_dot(v, h) > REAL(0.0)))
        return REAL(0.0);
    return reflectance * microfacet_d(surface.distribution, surface.alpha, h) / (REAL(4.0) * area);
}

/// Density, 1/sr, of the light that facets visible from v refract, which let the share
/// `transmittance` pass; shadowing left out.
DEVICE_FUNCTION real walk_refraction_density(WalkSurface surface, Vec3 v, WalkRefraction r,
                                             real transmittance) {
    const real area = walk_visible_area(surface, v);
    if (!(r.jacobian > REAL(0.0)) || !(area > REAL(0.0)))
        return REAL(0.0);
    return transmittance * r.cos_i / area * r.jacobian *
           microfacet_d(surface.distribution, surface.alpha, r.h);
}

/// Share of a facet of a V-cavity that v sees: G1 (Cook and Torrance 1982 eq. 3).
DEVICE_FUNCTION real walk_cavity_seen(Vec3 v, Vec3 h, real cos_v) {
    return fmin(REAL(1.0), REAL(2.0) * h.z * v.z / fmax(cos_v, REAL(1e-20)));
}

/// A facet as it is seen from v, u uniform. The two facets of a V-cavity are picked by the area
/// that they show (Heitz and d'Eon 2014, section 4), so that no weight exceeds 1.
DEVICE_FUNCTION Vec3 walk_sample_facet(WalkSurface surface, Vec3 v, real u1, real u2, real u) {
    const Vec3 h = microfacet_sample(surface.distribution, surface.alpha, v, u1, u2);
    if (surface.distribution == MICROFACET_BLINN) {
        const Vec3 other = vec3(-h.x, -h.y, h.z);
        const real seen = fmax(vec3_dot(v, h), REAL(0.0));
        const real other_seen = fmax(vec3_dot(v, other), REAL(0.0));
        return u * (seen + other_seen) < other_seen ? other : h;
    }
    return h;
}

/// Density of walk_sample_facet, 1/sr: G1 (v.h) D(h) / v.z.
DEVICE_FUNCTION real walk_facet_pdf(WalkSurface surface, Vec3 v, Vec3 h) {
    if (surface.distribution == MICROFACET_BLINN) {
        const real cos_v = fmax(vec3_dot(v, h), REAL(0.0));
        return microfacet_d(surface.distribution, surface.alpha, h) * cos_v *
               walk_cavity_seen(v, h, cos_v) / v.z;
    }
    return microfacet_pdf(surface.distribution, surface.alpha, v, h);
}

/// Share of a seen facet's light that gets out when only one meeting counts: G2 / G1.
DEVICE_FUNCTION real walk_single_share(WalkSurface surface, Vec3 v, Vec3 h, Vec3 w, real cos_w) {
    if (surface.distribution == MICROFACET_BLINN) {
        const real seen = walk_cavity_seen(v, h, vec3_dot(v, h));
        return fmin(seen, walk_cavity_seen(w, h, cos_w)) / fmax(seen, REAL(1e-20));
    }
    {
        const real seen = REAL(1.0) + walk_lambda(surface, v);
        return seen / (seen + walk_lambda(surface, w));
    }
}

/// Returns the share of light towards w that single scattering lets out, over a facet as
/// microfacet_sample draws it; blinn is drawn without masking: G2 (v.h) / (v.z h.z), up to 2.
DEVICE_FUNCTION real walk_drawn_share(WalkSurface surface, Vec3 v, Vec3 h, Vec3 w, real cos_w) {
    if (surface.distribution == MICROFACET_BLINN) {
        const real cos_v = vec3_dot(v, h);
        return fmin(walk_cavity_seen(v, h, cos_v), walk_cavity_seen(w, h, cos_w)) * cos_v /
               (v.z * h.z);
    }
    return walk_single_share(surface, v, h, w, cos_w);
}

/// Density, 1/sr with the cosine of w, of what facets reflect into w and nothing masks.
DEVICE_FUNCTION real walk_single_reflection(WalkSurface surface, Vec3 v, Vec3 w, real reflectance) {
    return reflectance * w.z * microfacet_reflection(surface.distribution, surface.alpha, v, w);
}

/// Density, 1/sr with the cosine of w, of what facets refract into w and nothing masks.
DEVICE_FUNCTION real walk_single_refraction(WalkSurface surface, Vec3 v, Vec3 w, WalkRefraction r,
                                            real transmittance) {
    return r.jacobian > REAL(0.0)
               ? transmittance * r.jacobian * walk_facet_pdf(surface, v, r.h) *
                     walk_single_share(surface, v, r.h, walk_mirrored(w), r.cos_t)
               : REAL(0.0);
}

KERNELS_END

#endif
