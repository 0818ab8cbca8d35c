// Rays as the stages write them for the host to trace.
#ifndef RERADIANT_RAYS_H
#define RERADIANT_RAYS_H

#include "kernels/core/portable.h"
#include "kernels/core/shared.h"

RayRecord ray_record(Vec3 origin, Vec3 direction, real t_far) {
    RayRecord ray;
    ray.origin_x = origin.x;
    ray.origin_y = origin.y;
    ray.origin_z = origin.z;
    ray.t_near = 0.0f;
    ray.direction_x = direction.x;
    ray.direction_y = direction.y;
    ray.direction_z = direction.z;
    ray.t_far = t_far;
    return ray;
}

/// A ray that is not traced.
RayRecord ray_inactive(void) {
    return ray_record(vec3(0.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 1.0f), -1.0f);
}

int ray_is_active(RayRecord ray) {
    return ray.t_far >= 0.0f;
}

Vec3 ray_origin(RayRecord ray) {
    return vec3(ray.origin_x, ray.origin_y, ray.origin_z);
}
Vec3 ray_direction(RayRecord ray) {
    return vec3(ray.direction_x, ray.direction_y, ray.direction_z);
}

Vec3 hit_position(HitRecord hit) {
    return vec3(hit.position_x, hit.position_y, hit.position_z);
}
Vec3 hit_normal(HitRecord hit) {
    return vec3(hit.normal_x, hit.normal_y, hit.normal_z);
}

/// A ray from a surface. It begins off the surface on the side of `direction`, beyond the
/// position's error bound (after Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed.,
/// section 6.8.6).
RayRecord ray_from(HitRecord hit, Vec3 direction, real t_far) {
    const Vec3 n = hit_normal(hit);
    const real reach = 2.0f * hit.position_error * (fabs(n.x) + fabs(n.y) + fabs(n.z));
    const real side = vec3_dot(n, direction) < 0.0f ? -reach : reach;
    return ray_record(vec3_add(hit_position(hit), vec3_scale(n, side)), direction, t_far);
}

#endif
