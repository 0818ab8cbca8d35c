// Stage 3: at each hit, record a vertex, sample one light and one direction. Only scalars here:
// directions, pdfs, weights. Wavelengths come in `gather`.
#include "kernels/environment.h"
#include "kernels/features.h"
#include "kernels/layer_stack.h"
#include "kernels/lights.h"
#include "kernels/portable.h"
#include "kernels/random.h"
#include "kernels/sampling.h"
#include "kernels/sequence.h"
#include "kernels/shared.h"
#include "kernels/texture.h"
#if FEATURE_WALK
#include "kernels/walk.h"
#endif

/// Random dimensions of textures, far from those of lights and directions.
#define TEXTURE_DIMENSION 0x40000000u
/// The same of walks through stacks; each vertex of a path has a range of its own.
#define WALK_DIMENSION 0x80000000u
#define WALK_DIMENSIONS_PER_VERTEX 0x100000u

/// What the stage reads of the scene.
typedef struct {
    __global const MaterialRecord* materials;
    __global const LayerRecord* layers;
    __global const LobeRecord* lobes;
    __global const SurfaceRecord* surfaces;
    __global const TextureRecord* textures;
    __global const LightRecord* lights;
    __global const float* tables;
    EnvironmentRecord image; ///< the environment where it is an image
    uint light_count;
    uint environment; ///< light of a constant environment, or NO_INDEX
} ShadeScene;

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
    uint material;
} SurfacePoint;

#if FEATURE_TEXTURES
/// The normal tilted by two slopes, along the horizontal on the surface and across it.
Vec3 tilted_normal(Vec3 normal, real slope_x, real slope_y) {
    const Vec3 horizontal = vec3(normal.z, 0.0f, -normal.x); // +y cross normal
    const real size2 = vec3_dot(horizontal, horizontal);
    const Vec3 tangent =
        size2 > 1e-12f ? vec3_scale(horizontal, 1.0f / sqrt(size2)) : vec3(1.0f, 0.0f, 0.0f);
    const Vec3 bitangent = vec3_cross(normal, tangent);
    return vec3_normalise(
        vec3_add(normal, vec3_add(vec3_scale(tangent, slope_x), vec3_scale(bitangent, slope_y))));
}

TexturePoint texture_here(const ShadeScene* scene, uint texture, HitRecord hit) {
    return texture_at(scene->textures[texture],
                      vec3(hit.position_x, hit.position_y, hit.position_z), hit.u, hit.v,
                      scene->tables);
}

/// The material of a surface at a point, one level of each texture picked by u.a, u.b, u.c, a
/// mixture's side by u.d; *normal is tilted where the surface says so.
uint choose_material(const ShadeScene* scene, HitRecord hit, Random4 u, Vec3 to_camera,
                     Vec3* normal) {
    SurfaceRecord surface = scene->surfaces[hit.material];
    if (surface.mixed_with != NO_INDEX) {
        const real weight = surface.mix_texture == NO_INDEX
                                ? surface.mix_weight
                                : texture_here(scene, surface.mix_texture, hit).value;
        if (u.d < weight)
            surface = scene->surfaces[surface.mixed_with];
    }
    const real random[MAX_TEXTURES] = {u.a, u.b, u.c};
    uint variant = 0u;
    for (uint i = 0u; i < surface.texture_count; ++i) {
        const uint levels = scene->textures[surface.textures[i]].levels;
        variant =
            variant * levels +
            texture_level(texture_here(scene, surface.textures[i], hit).value, levels, random[i]);
    }
    if (surface.normal_texture != NO_INDEX) {
        const TexturePoint point = texture_here(scene, surface.normal_texture, hit);
        const Vec3 tilted = tilted_normal(*normal, point.slope_x, point.slope_y);
        if (vec3_dot(tilted, to_camera) > 0.0f)
            *normal = tilted;
    }
    return surface.first_material + variant;
}
#endif

/// The frame stands on the shading normal, or on the geometric one where the shading normal faces
/// away from the camera.
SurfacePoint surface_point(const ShadeScene* scene, HitRecord hit, RayRecord ray, Random4 u) {
    const Vec3 to_camera = vec3(-ray.direction_x, -ray.direction_y, -ray.direction_z);
    SurfacePoint point;
    point.hit = hit;
    point.geometric = vec3(hit.normal_x, hit.normal_y, hit.normal_z);
    Vec3 shading = vec3(hit.shading_x, hit.shading_y, hit.shading_z);
    if (vec3_dot(point.geometric, to_camera) < 0.0f) {
        point.geometric = vec3_scale(point.geometric, -1.0f);
        shading = vec3_scale(shading, -1.0f);
    }
    shading = vec3_dot(shading, to_camera) > 0.0f ? shading : point.geometric;
    point.material = hit.material;
#if FEATURE_TEXTURES
    point.material = choose_material(scene, hit, u, to_camera, &shading);
#endif
    point.frame = sampling_frame(shading);
    point.wo = sampling_to_local(point.frame, to_camera);
    return point;
}

VertexRecord empty_vertex(void) {
    const DirectionRecord nothing = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
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
    const real survival =
        depth + 1u < min_depth ? 1.0f : fmin(1.0f, fmax(state->throughput, 0.05f));
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

    state.throughput *= choice.albedo;
    const real survival = depth + 1u < min_depth ? 1.0f : fmin(1.0f, fmax(state.throughput, 0.05f));
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
