// Stage 3: at each hit, record a vertex, sample one light and one direction. Only scalars here:
// directions, pdfs, weights. Wavelengths come in `gather`.
#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/random.h"
#include "kernels/core/sampling.h"
#include "kernels/core/sequence.h"
#include "kernels/core/shared.h"
#include "kernels/scene/lights.h"
#include "kernels/stack/layer_stack.h"
#include "kernels/stages/shade_lights.h"
#include "kernels/stages/shade_surface.h"
#if FEATURE_WALK
#include "kernels/walk/walk.h"
#endif

/// Random dimensions of walks through stacks, far from all others; each vertex of a path has a
/// range of its own.
#define WALK_DIMENSION 0x80000000u
#define WALK_DIMENSIONS_PER_VERTEX 0x100000u

/// Below this throughput a path is put under Russian roulette, and survives at least at the second.
#define ROULETTE_THROUGHPUT REAL(0.1)
#define ROULETTE_LEAST_SURVIVAL REAL(0.05)

/// Probability with which a path goes on from its vertex `depth` (0 is the first). `throughput`
/// bounds what the lane that carries most still brings: with the mean of the lanes in its place a
/// saturated colour's bright lanes would hang on few paths of large weight.
real path_survival(real throughput, uint depth, uint min_depth) {
    if (depth + 1u < min_depth)
        return REAL(1.0);
    return fmin(REAL(1.0),
                fmax(throughput * (REAL(1.0) / ROULETTE_THROUGHPUT), ROULETTE_LEAST_SURVIVAL));
}

/// The scalar weights of all components in one direction; `scale` holds cos / pdf.
DirectionRecord direction_weights(LayerStackView stack, Vec3 wi, Vec3 wo, real scale,
                                  __global float* lobe_weights) {
    DirectionRecord d = {wi.x, wi.y, wi.z, 0.0f, 0.0f, scale, 0.0f, 0.0f};
    const LayerDiffuse factors = layer_stack_diffuse(stack, wi, wo);
    d.diffuse = scale * factors.diffuse;
    d.first = scale * factors.first;
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
RayRecord sample_light(const ShadeScene* scene, SurfacePoint point, LayerStackView stack,
                       const LayerChoice* choice, Random4 u, VertexRecord* vertex,
                       __global float* lobe_weights, __global float* colour) {
    uint chosen;
    Vec3 wi;
    const LightSample sample = light_from_here(scene, point, u, &chosen, &wi, colour);
    if (!(sample.weight > 0.0f))
        return ray_record(vec3(0.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 1.0f), -1.0f);
    const LightRecord light = scene->lights[chosen];
    real scale = wi.z * sample.weight / light.selection;
    if (sample.pdf > 0.0f)
        scale *= lights_mis_weight(light.selection * sample.pdf,
                                   layer_stack_pdf(stack, choice, point.wo, wi));
    vertex->light = chosen;
    vertex->towards_light = direction_weights(stack, wi, point.wo, scale, lobe_weights);
    return shadow_ray(point, sample);
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
        DirectionRecord mirror = {wi.x, wi.y, wi.z, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
        mirror.delta = 1.0f / (choice->cumulative[CHOICE_DELTA] * survival);
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

#if FEATURE_WALK
/// A walk at a vertex, connected to one light where lights are sampled; fills *vertex,
/// *walk_vertex and *shadow (as it is when there is no light), and returns the ray along which the
/// path goes on (inactive when it ends here). u_light: chooses light and direction, u: survival.
RayRecord walk_from_here(const ShadeScene* scene, SurfacePoint point, Walk* walk, Random4 u_light,
                         real u, uint depth, uint min_depth, VertexRecord* vertex,
                         __global WalkVertexRecord* walk_vertex, PathState* state,
                         __global RayRecord* shadow, __global float* colour) {
    RayRecord ray = ray_record(vec3(0.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 1.0f), -1.0f);
    WalkArrival arrivals[WALK_PLACES];
    walk_clear_arrivals(arrivals);
    walk->arrivals = arrivals;
#if FEATURE_LIGHT_SAMPLING
    Vec3 wi;
    uint chosen;
    if (scene->light_count > 0u) {
        const LightSample sample = light_from_here(scene, point, u_light, &chosen, &wi, colour);
        if (sample.weight > 0.0f) {
            vertex->light = chosen;
            walk_light(walk->stack, wi, sample.weight / scene->lights[chosen].selection,
                       &walk->random, arrivals);
            *shadow = shadow_ray(point, sample);
        }
    }
#endif
    const WalkEnd end = walk_stack(walk, point.wo);
    const Vec3 direction = sampling_to_world(point.frame, end.direction);
    state->throughput *= end.expected;
    const real survival = path_survival(state->throughput, depth, min_depth);
    if (end.weight > 0.0f && u < survival && vec3_dot(point.geometric, direction) > 0.0f) {
        vertex->has_next = 1u;
        state->throughput /= survival;
        state->bsdf_pdf = end.is_delta ? -1.0f : 0.0f; // 0: lights are left to the connections
        ray = ray_record(offset_origin(point.hit, direction), direction, INFINITY);
    }
    const WalkVertexRecord record = {walk->writer.chunk, walk->writer.count, walk->reference,
                                     end.weight / survival};
    *walk_vertex = record;
    return ray;
}
#endif

__kernel void shade(__global RayRecord* rays, __global const HitRecord* hits,
                    __global PathState* paths, __global VertexRecord* vertices,
                    __global RayRecord* shadow_rays, __global float* lobe_weights,
                    __global float* colours, __global const MaterialRecord* materials,
                    __global const LayerRecord* layers, __global const LobeRecord* lobes,
                    __global const SurfaceRecord* surfaces, __global const TextureRecord* textures,
                    __global const LightRecord* lights, __global const float* tables,
                    __global const WalkPartRecord* walk_parts, __global WalkChunk* walk_chunks,
                    __global uint* walk_chunks_used, __global WalkVertexRecord* walk_vertices,
                    __global const uint* live, __global uchar* goes_on, EnvironmentRecord image,
                    uint walk_capacity, uint live_count, uint capacity, uint depth, uint max_depth,
                    uint min_depth, uint light_count, uint environment, uint sequence_blocks,
                    uint seed) {
    const uint item = (uint)get_global_id(0);
    if (item >= live_count)
        return;
    const uint path = live[item];
    const ShadeScene scene = {materials, layers, lobes, surfaces,    textures,
                              lights,    tables, image, light_count, environment};
    const uint slot = depth * capacity + path;
    const RayRecord ray = rays[path];
#if FEATURE_LIGHT_SAMPLING
    shadow_rays[slot].t_far = -1.0f;
#endif
    goes_on[item] = 0;
    const HitRecord hit = hits[path];
    PathState state = paths[path];
    __global float* colour = colours;
#if FEATURE_COLOURS
    colour += (size_t)slot * VERTEX_COLOURS;
#endif
    if (end_on_emitter(&scene, ray, hit, state, vertices + slot, paths + path, colour, depth) ||
        depth >= max_depth)
        return;

    const SurfacePoint point = surface_point(
        &scene, hit, ray, random_4(state.pixel, state.sample, TEXTURE_DIMENSION + depth, seed));
    LayerStackView stack;
    stack.record = materials[point.material];
    stack.layers = layers + stack.record.first_layer;
    stack.lobes = lobes + stack.record.first_lobe;
    stack.choice = tables + stack.record.choice;
    __global float* next_lobes = lobe_weights + (size_t)slot * (2u * LOBES);
    VertexRecord vertex = empty_vertex();
    vertex.material = point.material;
    vertex.out_x = point.wo.x;
    vertex.out_y = point.wo.y;
    vertex.out_z = point.wo.z;
#if FEATURE_REFLECTANCE_IMAGE
    if (stack.record.reflectance_image != NO_INDEX) {
        const TexturePoint texel =
            texture_at(textures[stack.record.reflectance_image],
                       vec3(hit.position_x, hit.position_y, hit.position_z), hit.u, hit.v, tables);
        colour[3] = texel.red;
        colour[4] = texel.green;
        colour[5] = texel.blue;
    }
#endif

    const RandomBlocks numbers =
        path_numbers(state.pixel, state.sample, 2u * depth + 1u, sequence_blocks, seed);
    const Random4 u_light = numbers.first, u = numbers.second;
    state.vertex_count = depth + 1u;
#if FEATURE_WALK
    if (stack.record.walk != NO_INDEX) {
        Walk walk;
        walk.stack.parts = walk_parts + stack.record.walk;
        walk.stack.tables = tables;
        walk.stack.count = stack.record.layer_count;
        walk.stack.sigma = stack.record.sigma;
        walk.writer = walk_writer(walk_chunks, walk_chunks_used, walk_capacity);
        walk.random = walk_random(state.pixel, state.sample,
                                  WALK_DIMENSION + depth * WALK_DIMENSIONS_PER_VERTEX, seed);
        const RayRecord next =
            walk_from_here(&scene, point, &walk, u_light, u.d, depth, min_depth, &vertex,
                           walk_vertices + slot, &state, shadow_rays + slot, colour);
        rays[path] = next;
        goes_on[item] = next.t_far >= 0.0f;
        vertices[slot] = vertex;
        paths[path] = state;
        return;
    }
#endif
    const LayerChoice choice = layer_stack_choice(stack, point.wo.z);
#if FEATURE_LIGHT_SAMPLING
    if (light_count > 0u)
        shadow_rays[slot] = sample_light(&scene, point, stack, &choice, u_light, &vertex,
                                         next_lobes + LOBES, colour);
#endif

    state.throughput *= choice.largest_albedo;
    const real survival = path_survival(state.throughput, depth, min_depth);
    if (u.d < survival) {
        real density = state.bsdf_pdf; // as it was where no direction is found
        const RayRecord next =
            sample_direction(point, stack, &choice, u, survival, &vertex, next_lobes, &density);
        state.bsdf_pdf = density;
        rays[path] = next;
        goes_on[item] = next.t_far >= 0.0f;
        state.throughput /= survival;
    }
    vertices[slot] = vertex;
    paths[path] = state;
}
