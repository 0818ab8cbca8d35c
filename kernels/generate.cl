// Stage 1: camera rays. One work-item a path; path = local pixel * samples + local sample. The
// batch's pixels follow each other from `first_pixel` on and go on with the same sample, or, where
// they are `listed`, they are those of `pixels` from there on, each with its own.
#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/sequence.h"
#include "kernels/core/shared.h"
#include "kernels/core/wavelength.h"
#include "kernels/scene/camera.h"

__kernel void generate(__global RayRecord* rays, __global PathState* paths,
                       __global const PixelSamples* pixels, uint listed, CameraRecord camera,
                       uint first_pixel, uint first_sample, uint samples, uint path_count,
                       uint phases, uint sequence_blocks, uint seed) {
    const uint path = (uint)get_global_id(0);
    if (path >= path_count)
        return;
    const uint place = first_pixel + path / samples;
    const uint pixel = listed != 0u ? pixels[place].pixel : place;
    const uint sample =
        first_sample + path % samples + (listed != 0u ? pixels[place].first_sample : 0u);
    const Random4 u = path_numbers(pixel, sample, 0u, sequence_blocks, seed).first;
    const CameraRay camera_space = camera_ray(camera, (real)(pixel % camera.width) + u.b,
                                              (real)(pixel / camera.width) + u.c, u.a, u.d);
    RayRecord ray;
    ray.origin_x = camera_space.origin.x;
    ray.origin_y = camera_space.origin.y;
    ray.origin_z = camera_space.origin.z;
    ray.t_near = 0.0f;
    ray.direction_x = camera_space.direction.x;
    ray.direction_y = camera_space.direction.y;
    ray.direction_z = camera_space.direction.z;
    ray.t_far = INFINITY;
    rays[path] = ray;

    PathState state;
    state.pixel = pixel;
    state.sample = sample;
    state.phase = wavelength_phase(pixel, sample, phases, seed);
    state.vertex_count = 0u;
    state.bsdf_pdf = -1.0f;
    state.throughput = 1.0f;
    paths[path] = state;
}
