// Stage 3: at each hit, record a vertex, sample one light and one direction. Only scalars here:
// directions, pdfs, weights. Wavelengths come in `gather`.
#include "kernels/features.h"
#include "kernels/layer_stack.h"
#include "kernels/lights.h"
#include "kernels/portable.h"
#include "kernels/random.h"
#include "kernels/sampling.h"
#include "kernels/shared.h"

/// Origin moved off the surface to the side of `direction`, beyond the position's error bound
/// (after Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., section 6.8.6).
Vec3 offset_origin(HitRecord hit, Vec3 direction) {
    const Vec3 n = vec3(hit.normal_x, hit.normal_y, hit.normal_z);
    const real reach = 2.0f * hit.position_error * (fabs(n.x) + fabs(n.y) + fabs(n.z));
    const real side = vec3_dot(n, direction) < 0.0f ? -reach : reach;
    return vec3_add(vec3(hit.position_x, hit.position_y, hit.position_z), vec3_scale(n, side));
}

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

/// Where a path meets a material: local frame on the side the ray came from.
typedef struct {
    HitRecord hit;
    Frame frame;
    Vec3 geometric; ///< normal on the side of `to_camera`
    Vec3 wo;        ///< towards the camera, local
} SurfacePoint;

/// The frame stands on the shading normal, or on the geometric one where the shading normal faces
/// away from the camera.
SurfacePoint surface_point(HitRecord hit, RayRecord ray) {
    const Vec3 to_camera = vec3(-ray.direction_x, -ray.direction_y, -ray.direction_z);
    SurfacePoint point;
    point.hit = hit;
    point.geometric = vec3(hit.normal_x, hit.normal_y, hit.normal_z);
    Vec3 shading = vec3(hit.shading_x, hit.shading_y, hit.shading_z);
    if (vec3_dot(point.geometric, to_camera) < 0.0f) {
        point.geometric = vec3_scale(point.geometric, -1.0f);
        shading = vec3_scale(shading, -1.0f);
    }
    point.frame = sampling_frame(vec3_dot(shading, to_camera) > 0.0f ? shading : point.geometric);
    point.wo = sampling_to_local(point.frame, to_camera);
    return point;
}

VertexRecord empty_vertex(void) {
    const DirectionRecord nothing = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f};
    VertexRecord vertex = {NO_INDEX, NO_INDEX, 0.0f, NO_INDEX, 0.0f,
                           0.0f,     1.0f,     0u,   nothing,  nothing};
    return vertex;
}

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

/// The scalar weights of all components in one direction; `scale` holds cos / pdf.
DirectionRecord direction_weights(LayerStackView stack, Vec3 wi, Vec3 wo, real scale,
                                  __global float* lobe_weights) {
    DirectionRecord d = {wi.x, wi.y, wi.z, 0.0f, 0.0f, 0.0f};
    d.diffuse = scale * layer_stack_diffuse(stack, wi, wo);
#if FEATURE_ROUGH
    if (stack.record.has_top_lobe)
        d.top = scale * layer_stack_top(stack, wi, wo);
#endif
#if FEATURE_DEEPER_LOBES
    for (uint l = 0u; l < stack.record.lobe_count; ++l)
        lobe_weights[l] = scale * layer_stack_deeper(stack, l, wi, wo);
#endif
    return d;
}

#if FEATURE_LIGHT_SAMPLING
/// Samples one light by selection probability; fills the vertex and returns the shadow ray
/// (inactive when the light cannot contribute).
RayRecord sample_light(SurfacePoint point, LayerStackView stack, const LayerChoice* choice,
                       __global const LightRecord* lights, uint light_count, Random4 u,
                       VertexRecord* vertex, __global float* lobe_weights) {
    RayRecord inactive = ray_record(vec3(0.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 1.0f), -1.0f);
    uint chosen = 0u;
    while (chosen + 1u < light_count && u.a >= lights[chosen].cumulative)
        ++chosen;
    const LightRecord light = lights[chosen];
    const Vec3 position = vec3(point.hit.position_x, point.hit.position_y, point.hit.position_z);
    const LightSample sample = lights_sample(light, position, u.b, u.c);
    const Vec3 wi = sampling_to_local(point.frame, sample.direction);
    if (!(sample.weight > 0.0f) || !(light.selection > 0.0f) || !(wi.z > 0.0f) ||
        !(vec3_dot(point.geometric, sample.direction) > 0.0f))
        return inactive;
    real scale = wi.z * sample.weight / light.selection;
    if (sample.pdf > 0.0f)
        scale *= lights_mis_weight(light.selection * sample.pdf,
                                   layer_stack_pdf(stack, choice, point.wo, wi));
    vertex->light = chosen;
    vertex->towards_light = direction_weights(stack, wi, point.wo, scale, lobe_weights);
    return ray_record(offset_origin(point.hit, sample.direction), sample.direction,
                      sample.distance * 0.9999f);
}
#endif

/// Samples the direction in which the path goes on; fills the vertex and returns the ray
/// (inactive when it ends here). *pdf: of the direction, < 0 for the mirror.
RayRecord sample_direction(SurfacePoint point, LayerStackView stack, const LayerChoice* choice,
                           Random4 u, real survival, VertexRecord* vertex,
                           __global float* lobe_weights, real* pdf) {
    RayRecord inactive = ray_record(vec3(0.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 1.0f), -1.0f);
    int is_delta;
    const Vec3 wi = layer_stack_sample(stack, choice, point.wo, u.a, u.b, u.c, &is_delta);
    const Vec3 direction = sampling_to_world(point.frame, wi);
    if (!(wi.z > 0.0f) || !(vec3_dot(point.geometric, direction) > 0.0f))
        return inactive;
    *pdf = is_delta ? -1.0f : layer_stack_pdf(stack, choice, point.wo, wi);
    if (is_delta) {
        const DirectionRecord mirror = {
            wi.x, wi.y, wi.z, 0.0f, 0.0f, 1.0f / (choice->cumulative[CHOICE_DELTA] * survival)};
        vertex->next = mirror;
#if FEATURE_DEEPER_LOBES
        for (uint l = 0u; l < stack.record.lobe_count; ++l)
            lobe_weights[l] = 0.0f;
#endif
    } else {
        if (!(*pdf > 0.0f))
            return inactive;
        vertex->next =
            direction_weights(stack, wi, point.wo, wi.z / (*pdf * survival), lobe_weights);
    }
    vertex->has_next = 1u;
    return ray_record(offset_origin(point.hit, direction), direction, INFINITY);
}

/// A path that left the scene or met a light ends with one record of what it sees there.
/// Returns 1 when it did.
int end_on_emitter(RayRecord ray, HitRecord hit, PathState state,
                   __global const LightRecord* lights, uint environment,
                   __global VertexRecord* vertex, __global PathState* path, uint depth) {
    if (hit.shape != NO_INDEX && hit.light == NO_INDEX)
        return 0;
    VertexRecord record = empty_vertex();
#if FEATURE_ENVIRONMENT
    if (hit.light == NO_INDEX) {
        record.emitter = environment;
        record.emitted = environment == NO_INDEX ? 0.0f : 1.0f;
    }
#endif
#if FEATURE_AREA_LIGHTS
    if (hit.light != NO_INDEX) {
        record.emitter = hit.light;
        record.emitted = emission_weight(lights[hit.light], ray, hit, state.bsdf_pdf);
    }
#endif
    if (record.emitted > 0.0f) {
        *vertex = record;
        path->vertex_count = depth + 1u;
    }
    return 1;
}

__kernel void shade(__global RayRecord* rays, __global const HitRecord* hits,
                    __global PathState* paths, __global VertexRecord* vertices,
                    __global RayRecord* shadow_rays, __global float* lobe_weights,
                    __global const MaterialRecord* materials, __global const LayerRecord* layers,
                    __global const LobeRecord* lobes, __global const LightRecord* lights,
                    __global const float* tables, uint path_count, uint capacity, uint depth,
                    uint max_depth, uint min_depth, uint light_count, uint environment, uint seed) {
    const uint path = (uint)get_global_id(0);
    if (path >= path_count)
        return;
    const uint slot = depth * capacity + path;
    const RayRecord ray = rays[path];
#if FEATURE_LIGHT_SAMPLING
    shadow_rays[slot].t_far = -1.0f;
#endif
    if (ray.t_far < 0.0f)
        return;
    rays[path].t_far = -1.0f;
    const HitRecord hit = hits[path];
    PathState state = paths[path];
    if (end_on_emitter(ray, hit, state, lights, environment, vertices + slot, paths + path,
                       depth) ||
        depth >= max_depth)
        return;

    const SurfacePoint point = surface_point(hit, ray);
    LayerStackView stack;
    stack.record = materials[hit.material];
    stack.layers = layers + stack.record.first_layer;
    stack.lobes = lobes + stack.record.first_lobe;
    stack.choice = tables + stack.record.choice;
    const LayerChoice choice = layer_stack_choice(stack, point.wo.z);
    __global float* next_lobes = lobe_weights + (size_t)slot * (2u * LOBES);
    VertexRecord vertex = empty_vertex();
    vertex.material = hit.material;
    vertex.out_x = point.wo.x;
    vertex.out_y = point.wo.y;
    vertex.out_z = point.wo.z;

#if FEATURE_LIGHT_SAMPLING
    if (light_count > 0u)
        shadow_rays[slot] = sample_light(point, stack, &choice, lights, light_count,
                                         random_4(state.pixel, state.sample, 2u * depth + 1u, seed),
                                         &vertex, next_lobes + LOBES);
#endif

    const Random4 u = random_4(state.pixel, state.sample, 2u * depth + 2u, seed);
    state.throughput *= choice.albedo;
    const real survival = depth + 1u < min_depth ? 1.0f : fmin(1.0f, fmax(state.throughput, 0.05f));
    if (u.d < survival) {
        rays[path] = sample_direction(point, stack, &choice, u, survival, &vertex, next_lobes,
                                      &state.bsdf_pdf);
        state.throughput /= survival;
    }
    state.vertex_count = depth + 1u;
    vertices[slot] = vertex;
    paths[path] = state;
}
