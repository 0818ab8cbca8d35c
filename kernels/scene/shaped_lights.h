// Light sampling by area: disks, and meshes of triangles. Both are met by chance as rectangles are:
// `lights_pdf` holds for them, with their area.
#ifndef RERADIANT_SHAPED_LIGHTS_H
#define RERADIANT_SHAPED_LIGHTS_H

#include "kernels/core/portable.h"
#include "kernels/core/sampling.h"
#include "kernels/core/shared.h"
#include "kernels/core/table.h"
#include "kernels/scene/lights.h"

KERNELS_BEGIN

typedef struct {
    Vec3 position, normal;
} LightPoint;

/// Point of a disk, uniform by area.
DEVICE_FUNCTION LightPoint shaped_lights_disk(LightRecord light, real u1, real u2) {
    const Vec3 place = sampling_disk(u1, u2);
    const Vec3 u = vec3_scale(vec3(light.ux, light.uy, light.uz), place.x);
    const Vec3 v = vec3_scale(vec3(light.vx, light.vy, light.vz), place.y);
    LightPoint point;
    point.position = vec3_add(vec3(light.px, light.py, light.pz), vec3_add(u, v));
    point.normal = vec3(light.nx, light.ny, light.nz);
    return point;
}

/// Point of a mesh, uniform by area: `u1` chooses the triangle, and what is left of it the place
/// (Osada et al., "Shape Distributions", ACM Transactions on Graphics 21(4), 2002, eq. 1).
DEVICE_FUNCTION LightPoint shaped_lights_mesh(LightRecord light, GLOBAL_CONST shared_float* tables,
                                              real u1, real u2) {
    GLOBAL_CONST shared_float* shares = tables + light.triangles;
    const uint chosen = table_search(shares, light.triangle_count - 1u, 1u, u1);
    const real before = chosen > 0u ? shares[chosen - 1u] : REAL(0.0);
    const real share = fmax(shares[chosen] - before, REAL(1e-30));
    const real root = sqrt(fmin(fmax((u1 - before) / share, REAL(0.0)), REAL(1.0)));
    GLOBAL_CONST shared_float* corners = shares + light.triangle_count + 9u * chosen;
    const Vec3 first = vec3(corners[0], corners[1], corners[2]);
    const Vec3 e1 = vec3_sub(vec3(corners[3], corners[4], corners[5]), first);
    const Vec3 e2 = vec3_sub(vec3(corners[6], corners[7], corners[8]), first);
    LightPoint point;
    point.position = vec3_add(
        first, vec3_add(vec3_scale(e1, root * (REAL(1.0) - u2)), vec3_scale(e2, root * u2)));
    point.normal = vec3_normalise(vec3_cross(e1, e2));
    return point;
}

/// Direction from a point towards a disk or mesh light.
DEVICE_FUNCTION LightSample shaped_lights_sample(LightRecord light,
                                                 GLOBAL_CONST shared_float* tables, Vec3 from,
                                                 real u1, real u2) {
    LightPoint point;
    if (light.type == LIGHT_DISK)
        point = shaped_lights_disk(light, u1, u2);
    else
        point = shaped_lights_mesh(light, tables, u1, u2);
    const Vec3 to_light = vec3_sub(point.position, from);
    LightSample s;
    s.distance = sqrt(vec3_dot(to_light, to_light));
    s.direction = vec3_scale(to_light, REAL(1.0) / fmax(s.distance, REAL(1e-30)));
    s.pdf = lights_rectangle_pdf(light.radius_or_area, s.distance,
                                 -vec3_dot(s.direction, point.normal));
    s.weight = s.pdf > REAL(0.0) ? REAL(1.0) / s.pdf : REAL(0.0);
    return s;
}

KERNELS_END

#endif
