// Thin-lens camera.
#ifndef RERADIANT_CAMERA_H
#define RERADIANT_CAMERA_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/sampling.h"
#include "kernels/core/shared.h"

KERNELS_BEGIN

typedef struct {
    Vec3 origin, direction;
} CameraRay;

/// Ray through (x, y) in pixels (0, 0 = upper left corner); (lens_u, lens_v) in [0, 1) pick the
/// point on the lens. Direction has unit length.
DEVICE_FUNCTION CameraRay camera_ray(CameraRecord camera, real x, real y, real lens_u,
                                     real lens_v) {
    const real sx = REAL(2.0) * x / (real)camera.width - REAL(1.0);
    const real sy = REAL(1.0) - REAL(2.0) * y / (real)camera.height;
    const Vec3 right = vec3(camera.right_x, camera.right_y, camera.right_z);
    const Vec3 up = vec3(camera.up_x, camera.up_y, camera.up_z);
    const Vec3 forward = vec3(camera.forward_x, camera.forward_y, camera.forward_z);
    Vec3 direction = vec3_add(forward, vec3_add(vec3_scale(right, sx), vec3_scale(up, sy)));
    CameraRay ray;
    ray.origin = vec3(camera.origin_x, camera.origin_y, camera.origin_z);
#if FEATURE_LENS
    const Vec3 focus = vec3_scale(direction, camera.focus_distance);
    const Vec3 disk = sampling_disk(lens_u, lens_v);
    const Vec3 lens = vec3_add(vec3_scale(vec3_normalise(right), camera.lens_radius * disk.x),
                               vec3_scale(vec3_normalise(up), camera.lens_radius * disk.y));
    ray.origin = vec3_add(ray.origin, lens);
    direction = vec3_sub(focus, lens);
#endif
    ray.direction = vec3_normalise(direction);
    return ray;
}

KERNELS_END

#endif
