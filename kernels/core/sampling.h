// Mapping of uniform numbers to directions, and local frames.
#ifndef RERADIANT_SAMPLING_H
#define RERADIANT_SAMPLING_H

#include "kernels/core/portable.h"

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

/// Cosine and sine of 2 pi u, 0 <= u <= 1, as x and y.
#if defined(__OPENCL_VERSION__) && !defined(KERNELS_IN_DOUBLE)
/// The nearest quarter turn comes off without rounding; for the rest, of at most pi / 4, the
/// polynomials of Cephes' sinf and cosf (Moshier 1992) are right to 2^-24. The built-in functions
/// must reduce any argument.
Vec3 sampling_circle(float u) {
    const float quarters = floor(4.0f * u + 0.5f);
    const float t = (4.0f * u - quarters) * (0.5f * PI_REAL), t2 = t * t;
    const float s =
        t + t * t2 * ((-1.9515295891e-4f * t2 + 8.3321608736e-3f) * t2 - 1.6666654611e-1f);
    const float c =
        1.0f - 0.5f * t2 +
        t2 * t2 *
            ((2.443315711809948e-5f * t2 - 1.388731625493765e-3f) * t2 + 4.166664568298827e-2f);
    const int turn = (int)quarters;
    const float x = (turn & 1) != 0 ? s : c, y = (turn & 1) != 0 ? c : s;
    return vec3(((turn + 1) & 2) != 0 ? -x : x, (turn & 2) != 0 ? -y : y, 0.0f);
}
#else
DEVICE_FUNCTION Vec3 sampling_circle(real u) {
    const real phi = REAL(2.0) * PI_REAL * u;
    return vec3(cos(phi), sin(phi), REAL(0.0));
}
#endif

/// Point on the unit disk, uniform (polar map).
DEVICE_FUNCTION Vec3 sampling_disk(real u1, real u2) {
    return vec3_scale(sampling_circle(u2), sqrt(u1));
}

/// Direction with pdf cos / pi.
DEVICE_FUNCTION Vec3 sampling_cosine(real u1, real u2) {
    Vec3 p = sampling_disk(u1, u2);
    p.z = sqrt(fmax(REAL(0.0), REAL(1.0) - u1));
    return p;
}

KERNELS_END

#endif
