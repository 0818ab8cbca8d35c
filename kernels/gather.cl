// Stage 5: radiance of each path, from its last vertex back to the camera. At every vertex one
// linear operator acts on a vector of wavelengths: L = T(o) B (T(i) L_in) + specular, where B
// holds the substrate with all its interreflections (host/README.md).
#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/stages/gather_hero.h"
#include "kernels/stages/gather_lanes.h"
#include "kernels/stages/gather_specular.h"
#include "kernels/stages/gather_substrate.h"
#include "kernels/stages/gather_walk.h"

/// Radiance that leaves a vertex; `radiance` holds what comes along `next` and receives the sum.
void gather_vertex(const GatherContext* context, const VertexRecord* vertex, int lit,
                   __global const float* light_spectrum, uint light_is_image,
                   __global const float* vertex_lobes, Lanes* radiance) {
    Lanes down[PATH_CHUNKS], up[PATH_CHUNKS];
#if FEATURE_OREN_NAYAR
    Lanes first[PATH_CHUNKS];
#else
    Lanes* const first = down;
#endif
#if FEATURE_HERO
    Lanes left[PATH_CHUNKS] = {(Lanes)(0.0f)}; // `up` is at other wavelengths than what leaves
    radiance[0] *= context->weights;
#else
    Lanes* const left = up;
#endif
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        down[c] = (Lanes)(0.0f);
#if FEATURE_OREN_NAYAR
        first[c] = (Lanes)(0.0f);
#endif
        up[c] = (Lanes)(0.0f);
    }
    const Vec3 wo = vec3(vertex->out_x, vertex->out_y, vertex->out_z);
    const TableStencil so = table_stencil(wo.z);
#if FEATURE_MODEL_A_PER_LANE
    const int per_lane = context->material.weidlich_wilkie == MODEL_A_PER_LANE;
#endif
    if (vertex->has_next) {
        gather_direction(context, vertex->next, wo, so, vertex_lobes, radiance, down, first, up);
#if FEATURE_MODEL_A_PER_LANE
        if (per_lane)
            leave_substrate_per_lane(context, vertex->next, wo, so, down, left);
#endif
    }
#if FEATURE_LIGHT_SAMPLING
    if (lit) {
        for (uint c = 0u; c < PATH_CHUNKS; ++c)
            radiance[c] = emission(context, light_spectrum, light_is_image, c);
#if FEATURE_HERO
        radiance[0] *= context->weights;
#endif
        gather_direction(context, vertex->towards_light, wo, so, vertex_lobes + LOBES, radiance,
                         down, first, up);
#if FEATURE_MODEL_A_PER_LANE
        if (per_lane)
            leave_substrate_per_lane(context, vertex->towards_light, wo, so, down, left);
#endif
    }
#endif
    leave_substrate(context, so, down, first, left);
#if FEATURE_HERO
    left[0] += context->material.shift == NO_INDEX
                   ? up[0]
                   : hero_unshifted(context->leaving, context->incoming, up[0]);
#endif
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance[c] = left[c];
}

__kernel void gather(__global float* radiance_out, __global const PathState* paths,
                     __global const VertexRecord* vertices, __global const RayRecord* shadow_rays,
                     __global const float* lobe_weights, __global const float* colours,
                     __global const MaterialRecord* materials, __global const LayerRecord* layers,
                     __global const LobeRecord* lobes, __global const LightRecord* lights,
                     __global const float* tables, __global const WalkPartRecord* walk_parts,
                     __global const WalkChunk* walk_chunks,
                     __global const WalkVertexRecord* walk_vertices, __global uint* hero_lanes,
                     __global float* hero_weights, uint hero_first, uint hero_count,
                     uint image_light, uint path_count, uint capacity, uint phases, uint seed) {
    const uint path = (uint)get_global_id(0);
    if (path >= path_count)
        return;
    const PathState state = paths[path];
    GatherContext context;
    context.tables = tables;
    context.phase = state.phase;
    context.phases = phases;
#if FEATURE_HERO
    const HeroSets sets = {hero_lanes, hero_weights, path, capacity};
    choose_lanes(sets, state, vertices, materials, tables,
                 hero_rotated(random_4(state.pixel, state.sample, HERO_DIMENSION, seed).a,
                              hero_first, hero_count),
                 seed);
#endif
    Lanes radiance[PATH_CHUNKS];
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance[c] = (Lanes)(0.0f);
    for (uint depth = state.vertex_count; depth-- > 0u;) {
        const size_t slot = (size_t)depth * capacity + path;
        const VertexRecord vertex = vertices[slot];
#if FEATURE_HERO
        set_lanes(&context, sets, depth, vertex.material == NO_INDEX);
#endif
        context.colour = colours;
#if FEATURE_COLOURS
        context.colour += slot * VERTEX_COLOURS;
#endif
        if (vertex.material == NO_INDEX) {
            __global const float* spectrum =
                tables + lights[vertex.emitter].spectrum + state.phase * LANES;
            for (uint c = 0u; c < PATH_CHUNKS; ++c)
                radiance[c] =
                    vertex.emitted * emission(&context, spectrum, vertex.emitter == image_light, c);
            continue;
        }
        context.material = materials[vertex.material];
        context.layers = layers + context.material.first_layer;
        context.lobes = lobes + context.material.first_lobe;
        int lit = 0;
        __global const float* spectrum = tables;
#if FEATURE_LIGHT_SAMPLING
        lit = vertex.light != NO_INDEX && shadow_rays[slot].t_far >= 0.0f;
        if (lit)
            spectrum = tables + lights[vertex.light].spectrum + state.phase * LANES;
#endif
#if FEATURE_WALK
        if (context.material.walk != NO_INDEX) {
            context.walk_parts = walk_parts + context.material.walk;
            gather_walk(&context, &vertex, walk_vertices[slot], walk_chunks, lit, spectrum,
                        vertex.light == image_light, radiance);
            continue;
        }
#endif
        gather_vertex(&context, &vertex, lit, spectrum, vertex.light == image_light,
                      lobe_weights + slot * (2u * LOBES), radiance);
    }
    radiance_out += (size_t)path * LANES;
#if FEATURE_HERO
    store_hero(HERO_LOAD(path, hero_lanes), radiance[0] * ((float)hero_count / HERO), radiance_out);
#else
    for (uint c = 0u; c < CHUNKS; ++c)
        vstore16(radiance[c], c, radiance_out);
#endif
}
