// Light in `shade`: what a path that has met a light or left the scene sees, and a light that a
// vertex looks for.
#ifndef RERADIANT_SHADE_LIGHTS_H
#define RERADIANT_SHADE_LIGHTS_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/scene/environment.h"
#include "kernels/scene/lights.h"
#if FEATURE_SPOT_LIGHTS || FEATURE_DISTANT_LIGHTS
#include "kernels/scene/cone_lights.h"
#endif
#if FEATURE_SHAPED_LIGHTS
#include "kernels/scene/shaped_lights.h"
#endif
#include "kernels/stages/rays.h"
#include "kernels/stages/shade_surface.h"

#if FEATURE_AREA_LIGHTS
/// Weight of the radiance that a direction found by chance sees on a light (MIS).
real emission_weight(LightRecord light, const ShadeStep* step) {
    const real cos_light = -vec3_dot(ray_direction(step->ray), hit_normal(step->hit));
    if (!(cos_light > 0.0f))
        return 0.0f;
    if (step->state.bsdf_pdf < 0.0f)
        return 1.0f;
    Vec3 from = ray_origin(step->ray);
    real distance = step->hit.distance;
#if FEATURE_PASSED_SHEETS
    from = vec3_sub(from, vec3_scale(ray_direction(step->ray), step->state.passed));
    distance += step->state.passed;
#endif
    const real light_pdf = light.selection * lights_pdf(light, from, distance, cos_light);
    return lights_mis_weight(step->state.bsdf_pdf, light_pdf);
}
#endif

#if FEATURE_DISTANT_LIGHTS
/// The distant light that a direction looks into, NO_INDEX where there is none. The first of
/// several hides the others, and all hide the environment.
uint distant_light_seen(const ShadeScene* scene, Vec3 direction) {
    for (uint i = 0u; i < scene->render.sampled_lights; ++i)
        if (scene->lights[i].type == LIGHT_DISTANT && scene->lights[i].selection > 0.0f &&
            cone_lights_holds(scene->lights[i], direction))
            return i;
    return NO_INDEX;
}

/// Weight of a distant light's spectrum for a direction found by chance (MIS).
real distant_weight(LightRecord light, const ShadeStep* step) {
    const real radiance = cone_lights_radiance(light);
    if (step->state.bsdf_pdf < 0.0f)
        return radiance;
    return radiance *
           lights_mis_weight(step->state.bsdf_pdf, light.selection * cone_lights_pdf(light));
}
#endif

#if FEATURE_ENVIRONMENT_IMAGE
/// Pdf per solid angle of the image's directions at a place of it; stores its colour there.
real environment_seen(const ShadeScene* scene, EnvironmentPlace place, __global float* colour) {
    for (uint c = 0u; c < 3u; ++c)
        colour[c] = environment_colour(scene->render.image, scene->tables, place, c);
    return environment_pdf(scene->render.image, scene->tables, place);
}

/// Weight of the image's radiance for a direction found by chance (MIS); stores its colour.
real environment_weight(const ShadeScene* scene, const ShadeStep* step) {
    const EnvironmentPlace place = environment_place(scene->render.image, ray_direction(step->ray));
    const real pdf = environment_seen(scene, place, step->colour);
    if (step->state.bsdf_pdf < 0.0f)
        return 1.0f;
    return lights_mis_weight(step->state.bsdf_pdf,
                             scene->lights[scene->render.image.light].selection * pdf);
}

LightSample sample_environment(const ShadeScene* scene, real u1, real u2, __global float* colour) {
    LightSample sample;
    sample.direction = environment_sample(scene->render.image, scene->tables, u1, u2);
    sample.distance = 1e30f;
    const EnvironmentPlace place = environment_place(scene->render.image, sample.direction);
    sample.pdf = environment_seen(scene, place, colour);
    sample.weight = sample.pdf > 0.0f ? 1.0f / sample.pdf : 0.0f;
    return sample;
}
#endif

/// Returns true when a path left the scene or met a light.
int is_on_emitter(HitRecord hit) {
    return hit.shape == NO_INDEX || hit.light != NO_INDEX;
}

/// Ends a path on an emitter, with a vertex where it sees some light there.
static void end_on_emitter(const ShadeScene* scene, ShadeStep* step) {
    VertexRecord* vertex = &step->vertex;
    const HitRecord hit = step->hit;
#if FEATURE_ENVIRONMENT
    if (hit.light == NO_INDEX) {
        vertex->emitter = scene->render.environment;
        vertex->emitted = scene->render.environment == NO_INDEX ? 0.0f : 1.0f;
    }
#endif
#if FEATURE_ENVIRONMENT_IMAGE
    if (hit.light == NO_INDEX && scene->render.image.light != NO_INDEX) {
        vertex->emitter = scene->render.image.light;
        vertex->emitted = environment_weight(scene, step);
    }
#endif
#if FEATURE_AREA_LIGHTS
    if (hit.light != NO_INDEX) {
        vertex->emitter = hit.light;
        vertex->emitted = emission_weight(scene->lights[hit.light], step);
    }
#endif
#if FEATURE_DISTANT_LIGHTS
    const uint distant =
        hit.light == NO_INDEX ? distant_light_seen(scene, ray_direction(step->ray)) : NO_INDEX;
    if (distant != NO_INDEX) {
        vertex->emitter = distant;
        vertex->emitted = distant_weight(scene->lights[distant], step);
    }
#endif
    if (vertex->emitted > 0.0f)
        step->state.vertex_count = step->depth + 1u;
}

#if FEATURE_LIGHT_SAMPLING
/// Direction from a place towards the light `chosen`; stores the colour of an image.
static LightSample sample_light(const ShadeScene* scene, uint chosen, Vec3 from, real u1, real u2,
                                __global float* colour) {
    const LightRecord light = scene->lights[chosen];
#if FEATURE_ENVIRONMENT_IMAGE
    if (light.type == LIGHT_ENVIRONMENT)
        return sample_environment(scene, u1, u2, colour);
#endif
#if FEATURE_DISTANT_LIGHTS
    if (light.type == LIGHT_DISTANT)
        return cone_lights_distant(light, u1, u2);
#endif
#if FEATURE_SPOT_LIGHTS
    if (light.type == LIGHT_SPOT)
        return cone_lights_spot(light, from);
#endif
#if FEATURE_SHAPED_LIGHTS
    if (light.type == LIGHT_DISK || light.type == LIGHT_MESH)
        return shaped_lights_sample(light, scene->tables, from, u1, u2);
#endif
    return lights_sample(light, from, u1, u2);
}

/// True where a distant light hides a light that is far away too.
static int is_light_hidden(const ShadeScene* scene, uint light, Vec3 direction) {
#if FEATURE_DISTANT_LIGHTS
    const uint type = scene->lights[light].type;
    if (type == LIGHT_ENVIRONMENT)
        return distant_light_seen(scene, direction) != NO_INDEX;
    if (type == LIGHT_DISTANT)
        return distant_light_seen(scene, direction) != light;
#endif
    return 0;
}

/// Looks for one light, chosen by selection probability, into a direction towards it: fills *wi in
/// the local frame and the step's shadow ray, and notes the light. Weight 0 where no light can
/// contribute, and then there is no ray.
static LightSample look_for_light(const ShadeScene* scene, SurfacePoint point, Random4 u, Vec3* wi,
                                  ShadeStep* step) {
    const uint chosen = lights_choose(scene->lights, scene->render.sampled_lights, u.a);
    LightSample sample =
        sample_light(scene, chosen, hit_position(step->hit), u.b, u.c, step->colour);
    *wi = sampling_to_local(point.frame, sample.direction);
    if (!(scene->lights[chosen].selection > 0.0f) ||
        !surface_is_left(point, *wi, sample.direction) ||
        is_light_hidden(scene, chosen, sample.direction))
        sample.weight = 0.0f;
    if (sample.weight > 0.0f) {
        step->vertex.light = chosen;
        step->shadow = ray_from(step->hit, sample.direction, sample.distance * 0.9999f);
    }
    return sample;
}
#endif

#endif
