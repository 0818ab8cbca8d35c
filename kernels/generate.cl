// Stage 1: camera rays, PATHS_TOGETHER of them a work-item; path = local pixel * samples + local
// sample.
#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/sequence.h"
#include "kernels/core/shared.h"
#include "kernels/core/wavelength.h"
#include "kernels/scene/camera.h"
#include "kernels/stages/arguments.h"
#include "kernels/stages/rays.h"

/// The pixel and the sample that are a path's own.
PixelSamples path_sample(BatchRecord batch, __global const PixelSamples* chosen, uint path) {
    const uint place = batch.first_pixel + path / batch.samples;
    PixelSamples own = {place, 0u};
    if (batch.chosen != 0u)
        own = chosen[place];
    own.first_sample += batch.first_sample + path % batch.samples;
    return own;
}

__kernel void generate(KERNEL_SIGNATURE(GENERATE_ARGUMENTS)) {
    const uint first = (uint)get_global_id(0) * PATHS_TOGETHER;
    const uint count = batch.pixels * batch.samples;
    if (first >= count)
        return;
    const uint together = min(count - first, (uint)PATHS_TOGETHER);
    Words pixel = 0u, sample = 0u;
    for (uint k = 0u; k < together; ++k) {
        const PixelSamples own = path_sample(batch, chosen, first + k);
        OF_PATH(uint, pixel, k) = own.pixel;
        OF_PATH(uint, sample, k) = own.first_sample;
    }
    const NumberBlock numbers =
        path_numbers(pixel, sample, 0u, render.sequence_blocks, render.seed);
    const Words phase = wavelength_phases(pixel, sample, render.phases, render.seed);

    for (uint k = 0u; k < together; ++k) {
        const uint own = OF_PATH(uint, pixel, k);
        const Random4 u = numbers_of_path(&numbers, k);
        const CameraRay ray = camera_ray(render.camera, (real)(own % render.camera.width) + u.b,
                                         (real)(own / render.camera.width) + u.c, u.a, u.d);
        const PathState state = {
            own, OF_PATH(uint, sample, k), OF_PATH(uint, phase, k), 0u, -1.0f, 1.0f, 0.0f, 0u};
        rays[first + k] = ray_record(ray.origin, ray.direction, INFINITY);
        paths[first + k] = state;
    }
}
