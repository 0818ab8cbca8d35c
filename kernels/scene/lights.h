// Light sampling: a direction towards a light, its pdf, and the pdf of a direction found by
// other means. Spectra are not looked at here: a sample's weight multiplies the light's table.
#ifndef RERADIANT_LIGHTS_H
#define RERADIANT_LIGHTS_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/sampling.h"
#include "kernels/core/shared.h"
#include "kernels/core/table.h"

KERNELS_BEGIN

/// The light that a uniform number chooses of the first `count`, at least one, by their selection
/// probabilities; the last one where rounding leaves none.
DEVICE_FUNCTION uint lights_choose(GLOBAL_CONST LightRecord* lights, uint count, real u) {
    return table_search(&lights->cumulative, count - 1u, sizeof(LightRecord) / sizeof(shared_float),
                        u);
}

/// Direction from a point towards a light. weight = light factor / pdf (selection not included),
/// 0 when the light cannot be seen; pdf per solid angle, 0 for point and directional lights.
typedef struct {
    Vec3 direction;
    real distance, weight, pdf;
} LightSample;

/// Solid angle pdf of hitting a rectangle at `distance` under `cos_light` on its front side.
DEVICE_FUNCTION real lights_rectangle_pdf(real area, real distance, real cos_light) {
    return cos_light > REAL(0.0) ? distance * distance / (area * cos_light) : REAL(0.0);
}

/// 1 - cos of the cone under which a sphere is seen, without cancellation for far spheres;
/// 0 from inside.
DEVICE_FUNCTION real lights_sphere_cone(real radius, real distance_to_centre) {
    const real s = radius / distance_to_centre;
    if (!(s < REAL(1.0)))
        return REAL(0.0);
    const real sin2 = s * s;
    return sin2 / (REAL(1.0) + sqrt(REAL(1.0) - sin2));
}

DEVICE_FUNCTION LightSample lights_sample_rectangle(LightRecord light, Vec3 from, real u1,
                                                    real u2) {
    const Vec3 centre = vec3(light.px, light.py, light.pz);
    const Vec3 u = vec3_scale(vec3(light.ux, light.uy, light.uz), u1 - REAL(0.5));
    const Vec3 v = vec3_scale(vec3(light.vx, light.vy, light.vz), u2 - REAL(0.5));
    const Vec3 to_light = vec3_sub(vec3_add(centre, vec3_add(u, v)), from);
    LightSample s;
    s.distance = sqrt(vec3_dot(to_light, to_light));
    s.direction = vec3_scale(to_light, REAL(1.0) / fmax(s.distance, REAL(1e-30)));
    const real cos_light = -vec3_dot(s.direction, vec3(light.nx, light.ny, light.nz));
    s.pdf = lights_rectangle_pdf(light.radius_or_area, s.distance, cos_light);
    s.weight = s.pdf > REAL(0.0) ? REAL(1.0) / s.pdf : REAL(0.0);
    return s;
}

/// Samples a direction uniformly over the cone of a sphere (Shirley, Wang and Zimmerman 1996); the
/// distance is that to the near surface.
DEVICE_FUNCTION LightSample lights_sample_sphere(LightRecord light, Vec3 from, real u1, real u2) {
    const Vec3 to_centre = vec3_sub(vec3(light.px, light.py, light.pz), from);
    const real d = sqrt(vec3_dot(to_centre, to_centre));
    const real cone = lights_sphere_cone(light.radius_or_area, d);
    LightSample s;
    s.direction = vec3(REAL(0.0), REAL(0.0), REAL(1.0));
    s.distance = REAL(0.0);
    s.weight = REAL(0.0);
    s.pdf = REAL(0.0);
    if (!(cone > REAL(0.0)))
        return s;
    const real one_minus_cos = u1 * cone;
    const real cosine = REAL(1.0) - one_minus_cos;
    const real sine = sqrt(one_minus_cos * (REAL(2.0) - one_minus_cos));
    const Vec3 around = sampling_circle(u2);
    const Frame frame = sampling_frame(vec3_scale(to_centre, REAL(1.0) / d));
    s.direction = sampling_to_world(frame, vec3(sine * around.x, sine * around.y, cosine));
    const real miss2 = d * sine * d * sine;
    s.distance = d * cosine - sqrt(fmax(REAL(0.0), square(light.radius_or_area) - miss2));
    s.pdf = REAL(1.0) / (REAL(2.0) * PI_REAL * cone);
    s.weight = REAL(2.0) * PI_REAL * cone;
    return s;
}

DEVICE_FUNCTION LightSample lights_sample(LightRecord light, Vec3 from, real u1, real u2) {
#if FEATURE_DELTA_LIGHTS
    if (light.type == LIGHT_DIRECTIONAL) {
        LightSample s;
        s.direction = vec3(-light.nx, -light.ny, -light.nz);
        s.distance = REAL(1e30);
        s.weight = REAL(1.0);
        s.pdf = REAL(0.0);
        return s;
    }
    if (light.type == LIGHT_POINT) {
        const Vec3 to_light = vec3_sub(vec3(light.px, light.py, light.pz), from);
        LightSample s;
        s.distance = sqrt(vec3_dot(to_light, to_light));
        s.direction = vec3_scale(to_light, REAL(1.0) / fmax(s.distance, REAL(1e-30)));
        s.weight = s.distance > REAL(0.0) ? REAL(1.0) / square(s.distance) : REAL(0.0);
        s.pdf = REAL(0.0);
        return s;
    }
#endif
    if (light.type == LIGHT_SPHERE)
        return lights_sample_sphere(light, from, u1, u2);
    return lights_sample_rectangle(light, from, u1, u2);
}

/// Solid angle pdf with which `lights_sample` would have chosen the direction that hit an area
/// light; `cos_light` is the cosine at the light.
DEVICE_FUNCTION real lights_pdf(LightRecord light, Vec3 from, real distance, real cos_light) {
    if (light.type == LIGHT_SPHERE) {
        const Vec3 to_centre = vec3_sub(vec3(light.px, light.py, light.pz), from);
        const real cone =
            lights_sphere_cone(light.radius_or_area, sqrt(vec3_dot(to_centre, to_centre)));
        return cone > REAL(0.0) ? REAL(1.0) / (REAL(2.0) * PI_REAL * cone) : REAL(0.0);
    }
    return lights_rectangle_pdf(light.radius_or_area, distance, cos_light);
}

/// Power heuristic with exponent 2 (Veach 1997, eq. 9.13), safe for huge pdfs.
DEVICE_FUNCTION real lights_mis_weight(real pdf, real other_pdf) {
    if (!(pdf > REAL(0.0)))
        return REAL(0.0);
    const real ratio = other_pdf / pdf;
    return REAL(1.0) / (REAL(1.0) + ratio * ratio);
}

KERNELS_END

#endif
