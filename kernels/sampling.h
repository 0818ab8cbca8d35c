// Mapping of uniform numbers to directions, and local frames.
#ifndef RERADIANT_SAMPLING_H
#define RERADIANT_SAMPLING_H

#include "kernels/portable.h"

KERNELS_BEGIN

typedef struct {
    Vec3 tangent, bitangent, normal;
} Frame;

/// Orthonormal frame around a unit normal (Duff et al., "Building an Orthonormal Basis,
/// Revisited", JCGT 6(1), 2017, listing 3).
DEVICE_FUNCTION Frame sampling_frame(Vec3 n) {
    const real sign = n.z >= REAL(0.0) ? REAL(1.0) : REAL(-1.0);
    const real a = REAL(-1.0) / (sign + n.z);
    const real b = n.x * n.y * a;
    Frame frame;
    frame.tangent = vec3(REAL(1.0) + sign * n.x * n.x * a, sign * b, -sign * n.x);
    frame.bitangent = vec3(b, sign + n.y * n.y * a, -n.y);
    frame.normal = n;
    return frame;
}

DEVICE_FUNCTION Vec3 sampling_to_local(Frame f, Vec3 v) {
    return vec3(vec3_dot(f.tangent, v), vec3_dot(f.bitangent, v), vec3_dot(f.normal, v));
}

DEVICE_FUNCTION Vec3 sampling_to_world(Frame f, Vec3 v) {
    return vec3_add(vec3_add(vec3_scale(f.tangent, v.x), vec3_scale(f.bitangent, v.y)),
                    vec3_scale(f.normal, v.z));
}

/// Point on the unit disk, uniform (polar map).
DEVICE_FUNCTION Vec3 sampling_disk(real u1, real u2) {
    const real r = sqrt(u1);
    const real phi = REAL(2.0) * PI_REAL * u2;
    return vec3(r * cos(phi), r * sin(phi), REAL(0.0));
}

/// Direction with pdf cos / pi.
DEVICE_FUNCTION Vec3 sampling_cosine(real u1, real u2) {
    Vec3 p = sampling_disk(u1, u2);
    p.z = sqrt(fmax(REAL(0.0), REAL(1.0) - u1));
    return p;
}

KERNELS_END

#endif
