// Light in `shade`: what a path that has met a light or left the scene sees, and a light that a
// vertex looks for.
#ifndef RERADIANT_SHADE_LIGHTS_H
#define RERADIANT_SHADE_LIGHTS_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/scene/environment.h"
#include "kernels/scene/lights.h"
#include "kernels/stages/shade_surface.h"

/// Weight of the radiance that a direction found by chance sees on a light (MIS).
real emission_weight(LightRecord light, RayRecord ray, HitRecord hit, real bsdf_pdf) {
    const Vec3 direction = vec3(ray.direction_x, ray.direction_y, ray.direction_z);
    const real cos_light = -vec3_dot(direction, vec3(hit.normal_x, hit.normal_y, hit.normal_z));
    if (!(cos_light > 0.0f))
        return 0.0f;
    if (bsdf_pdf < 0.0f)
        return 1.0f;
    const Vec3 from = vec3(ray.origin_x, ray.origin_y, ray.origin_z);
    const real light_pdf = light.selection * lights_pdf(light, from, hit.distance, cos_light);
    return lights_mis_weight(bsdf_pdf, light_pdf);
}

#if FEATURE_ENVIRONMENT_IMAGE
/// Weight of the image's radiance for a direction found by chance (MIS); stores its colour.
real environment_weight(const ShadeScene* scene, RayRecord ray, real bsdf_pdf,
                        __global float* colour) {
    const EnvironmentPlace place =
        environment_place(scene->image, vec3(ray.direction_x, ray.direction_y, ray.direction_z));
    for (uint c = 0u; c < 3u; ++c)
        colour[c] = environment_colour(scene->image, scene->tables, place, c);
    if (bsdf_pdf < 0.0f)
        return 1.0f;
    return lights_mis_weight(bsdf_pdf, scene->lights[scene->image.light].selection *
                                           environment_pdf(scene->image, scene->tables, place));
}
#endif

/// A path that left the scene or met a light ends with one record of what it sees there.
/// Returns 1 when it did.
int end_on_emitter(const ShadeScene* scene, RayRecord ray, HitRecord hit, PathState state,
                   __global VertexRecord* vertex, __global PathState* path, __global float* colour,
                   uint depth) {
    if (hit.shape != NO_INDEX && hit.light == NO_INDEX)
        return 0;
    VertexRecord record = empty_vertex();
#if FEATURE_ENVIRONMENT
    if (hit.light == NO_INDEX) {
        record.emitter = scene->environment;
        record.emitted = scene->environment == NO_INDEX ? 0.0f : 1.0f;
    }
#endif
#if FEATURE_ENVIRONMENT_IMAGE
    if (hit.light == NO_INDEX && scene->image.light != NO_INDEX) {
        record.emitter = scene->image.light;
        record.emitted = environment_weight(scene, ray, state.bsdf_pdf, colour);
    }
#endif
#if FEATURE_AREA_LIGHTS
    if (hit.light != NO_INDEX) {
        record.emitter = hit.light;
        record.emitted = emission_weight(scene->lights[hit.light], ray, hit, state.bsdf_pdf);
    }
#endif
    if (record.emitted > 0.0f) {
        *vertex = record;
        path->vertex_count = depth + 1u;
    }
    return 1;
}

#if FEATURE_ENVIRONMENT_IMAGE
LightSample sample_environment(const ShadeScene* scene, real u1, real u2, __global float* colour) {
    LightSample sample;
    sample.direction = environment_sample(scene->image, scene->tables, u1, u2);
    sample.distance = 1e30f;
    const EnvironmentPlace place = environment_place(scene->image, sample.direction);
    sample.pdf = environment_pdf(scene->image, scene->tables, place);
    sample.weight = sample.pdf > 0.0f ? 1.0f / sample.pdf : 0.0f;
    for (uint c = 0u; c < 3u; ++c)
        colour[c] = environment_colour(scene->image, scene->tables, place, c);
    return sample;
}
#endif

#if FEATURE_LIGHT_SAMPLING
/// The first light whose cumulative probability is above u; the last one where rounding leaves
/// none.
uint choose_light(const ShadeScene* scene, real u) {
    uint low = 0u, high = scene->light_count - 1u;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if (u < scene->lights[middle].cumulative)
            high = middle;
        else
            low = middle + 1u;
    }
    return low;
}

/// A direction to one light, chosen by selection probability; weight 0 when the light cannot
/// contribute. *wi: the direction in the local frame.
LightSample light_from_here(const ShadeScene* scene, SurfacePoint point, Random4 u, uint* chosen,
                            Vec3* wi, __global float* colour) {
    *chosen = choose_light(scene, u.a);
    const LightRecord light = scene->lights[*chosen];
    LightSample sample;
#if FEATURE_ENVIRONMENT_IMAGE
    if (light.type == LIGHT_ENVIRONMENT)
        sample = sample_environment(scene, u.b, u.c, colour);
    else
#endif
        sample = lights_sample(
            light, vec3(point.hit.position_x, point.hit.position_y, point.hit.position_z), u.b,
            u.c);
    *wi = sampling_to_local(point.frame, sample.direction);
    if (!(light.selection > 0.0f) || !(wi->z > 0.0f) ||
        !(vec3_dot(point.geometric, sample.direction) > 0.0f))
        sample.weight = 0.0f;
    return sample;
}

RayRecord shadow_ray(SurfacePoint point, LightSample sample) {
    return ray_record(offset_origin(point.hit, sample.direction), sample.direction,
                      sample.distance * 0.9999f);
}
#endif

#endif
