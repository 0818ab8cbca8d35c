// Lights that are bounded by a cone: spots, and distant lights such as the sun, which fill a cone
// of directions with the same radiance.
#ifndef RERADIANT_CONE_LIGHTS_H
#define RERADIANT_CONE_LIGHTS_H

#include "kernels/core/portable.h"
#include "kernels/core/sampling.h"
#include "kernels/core/shared.h"
#include "kernels/scene/lights.h"

KERNELS_BEGIN

/// Share of a spot's intensity along a unit direction away from it: 1 about the axis, 0 outside the
/// cone, between them s^2 (3 - 2 s) of the cosine (as in pbrt-v4's SpotLight).
DEVICE_FUNCTION real cone_lights_falloff(LightRecord light, Vec3 away) {
    const Vec3 axis = vec3(light.nx, light.ny, light.nz);
    const Vec3 apart = vec3_sub(away, axis);
    const real one_minus_cos = REAL(0.5) * vec3_dot(apart, apart); // cancels nothing in thin cones
    if (one_minus_cos <= light.full_cone)
        return REAL(1.0);
    if (one_minus_cos >= light.cone)
        return REAL(0.0);
    const real s = (light.cone - one_minus_cos) / (light.cone - light.full_cone);
    return s * s * (REAL(3.0) - REAL(2.0) * s);
}

/// Direction towards a spot; pdf 0, as of point lights.
DEVICE_FUNCTION LightSample cone_lights_spot(LightRecord light, Vec3 from) {
    const Vec3 to_light = vec3_sub(vec3(light.px, light.py, light.pz), from);
    LightSample s;
    s.distance = sqrt(vec3_dot(to_light, to_light));
    s.direction = vec3_scale(to_light, REAL(1.0) / fmax(s.distance, REAL(1e-30)));
    s.weight =
        s.distance > REAL(0.0)
            ? cone_lights_falloff(light, vec3_scale(s.direction, REAL(-1.0))) / square(s.distance)
            : REAL(0.0);
    s.pdf = REAL(0.0);
    return s;
}

/// Radiance of a distant light for a unit of irradiance on a plane that faces it: 1 / (pi sin^2) of
/// the half angle.
DEVICE_FUNCTION real cone_lights_radiance(LightRecord light) {
    return INV_PI_REAL / (light.cone * (REAL(2.0) - light.cone));
}

/// Pdf per solid angle within a distant light.
DEVICE_FUNCTION real cone_lights_pdf(LightRecord light) {
    return REAL(0.5) * INV_PI_REAL / light.cone;
}

/// Returns 1 where a unit direction looks into a distant light. By the sine, which keeps its digits
/// in thin cones.
DEVICE_FUNCTION int cone_lights_holds(LightRecord light, Vec3 direction) {
    const Vec3 travel = vec3(light.nx, light.ny, light.nz);
    const Vec3 across = vec3_cross(direction, travel);
    return vec3_dot(direction, travel) < REAL(0.0) &&
           vec3_dot(across, across) < light.cone * (REAL(2.0) - light.cone);
}

/// Direction into a distant light, uniform over its cone.
DEVICE_FUNCTION LightSample cone_lights_distant(LightRecord light, real u1, real u2) {
    const real one_minus_cos = u1 * light.cone;
    const real sine = sqrt(one_minus_cos * (REAL(2.0) - one_minus_cos));
    const Vec3 around = sampling_circle(u2);
    const Frame frame = sampling_frame(vec3(-light.nx, -light.ny, -light.nz));
    LightSample s;
    s.direction =
        sampling_to_world(frame, vec3(sine * around.x, sine * around.y, REAL(1.0) - one_minus_cos));
    s.distance = REAL(1e30);
    s.pdf = cone_lights_pdf(light);
    s.weight = cone_lights_radiance(light) / s.pdf;
    return s;
}

KERNELS_END

#endif
