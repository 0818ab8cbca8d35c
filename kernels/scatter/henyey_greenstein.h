// Scattering in a medium after Henyey and Greenstein 1941, of mean cosine g, -1 < g < 1.
#ifndef RERADIANT_HENYEY_GREENSTEIN_H
#define RERADIANT_HENYEY_GREENSTEIN_H

#include "kernels/core/portable.h"
#include "kernels/core/sampling.h"

KERNELS_BEGIN

/// Phase function, 1/sr over the sphere; (1 - g)^2 + 2 g (1 - cos) keeps its digits where g is near
/// 1.
DEVICE_FUNCTION real henyey_greenstein_phase(real g, real cos_deflection) {
    const real d = g < REAL(0.0)
                       ? square(REAL(1.0) + g) - REAL(2.0) * g * (REAL(1.0) + cos_deflection)
                       : square(REAL(1.0) - g) + REAL(2.0) * g * (REAL(1.0) - cos_deflection);
    return (REAL(1.0) - g) * (REAL(1.0) + g) * REAL(0.25) * INV_PI_REAL /
           (d * sqrt(fmax(d, REAL(1e-30))));
}

/// A direction scattered out of `direction` with the density henyey_greenstein_phase: 1 - cos =
/// (1 - g) (1 - u) (s + 1 - g) / (1 - g + 2 g u), s = (1 - g) (1 + g) / (1 - g + 2 g u), which
/// divides by no g and keeps its digits near g = 1.
DEVICE_FUNCTION Vec3 henyey_greenstein_sample(Vec3 direction, real g, real u1, real u2) {
    const real d = (REAL(1.0) - g) + REAL(2.0) * g * u1;
    const real s = (REAL(1.0) - g) * (REAL(1.0) + g) / d;
    const real fall =
        fmin((REAL(1.0) - g) * (REAL(1.0) - u1) * (s + (REAL(1.0) - g)) / d, REAL(2.0));
    const real sine = sqrt(fall * (REAL(2.0) - fall));
    const Vec3 around = sampling_circle(u2);
    return vec3_normalise(sampling_to_world(
        sampling_frame(direction), vec3(sine * around.x, sine * around.y, REAL(1.0) - fall)));
}

KERNELS_END

#endif
