// Stage 1: camera rays. One work-item a path; path = local pixel * samples + local sample.
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
    const uint path = (uint)get_global_id(0);
    if (path >= batch.pixels * batch.samples)
        return;
    const PixelSamples own = path_sample(batch, chosen, path);
    const uint pixel = own.pixel, sample = own.first_sample;

    const Random4 u = path_numbers(pixel, sample, 0u, render.sequence_blocks, render.seed).first;
    const CameraRay ray = camera_ray(render.camera, (real)(pixel % render.camera.width) + u.b,
                                     (real)(pixel / render.camera.width) + u.c, u.a, u.d);
    const PathState state = {
        pixel, sample, wavelength_phase(pixel, sample, render.phases, render.seed),
        0u,    -1.0f,  1.0f};

    rays[path] = ray_record(ray.origin, ray.direction, INFINITY);
    paths[path] = state;
}
