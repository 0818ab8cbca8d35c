// The numbers of sixteen paths at once, for comparison with those of one path.
#include "kernels/core/features.h"
#include "kernels/core/sequence.h"
#include "kernels/core/wavelength.h"

/// Paths i / 7 of samples i: eight numbers of each, of the sequence and independent, and its phase.
__kernel void together(__global float* numbers, __global uint* phases) {
    const uint first = (uint)get_global_id(0) * PATHS_TOGETHER;
    Words pixel = 0u, sample = 0u;
    for (uint k = 0u; k < PATHS_TOGETHER; ++k) {
        OF_PATH(uint, pixel, k) = (first + k) / 7u;
        OF_PATH(uint, sample, k) = first + k;
    }
    const NumberBlock u = path_numbers(pixel, sample, 3u, 7u, 42u);
    const NumberBlock v = path_numbers(pixel, sample, 8u, 7u, 42u);
    const Words phase = wavelength_phases(pixel, sample, 64u, 42u);
    for (uint k = 0u; k < PATHS_TOGETHER; ++k) {
        const Random4 of_u = numbers_of_path(&u, k), of_v = numbers_of_path(&v, k);
        __global float* own = numbers + 8u * (first + k);
        own[0] = of_u.a;
        own[1] = of_u.b;
        own[2] = of_u.c;
        own[3] = of_u.d;
        own[4] = of_v.a;
        own[5] = of_v.b;
        own[6] = of_v.c;
        own[7] = of_v.d;
        phases[first + k] = OF_PATH(uint, phase, k);
    }
}
