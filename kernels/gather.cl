// Stage 5: radiance of each path, from its last vertex back to the camera. At every vertex one
// linear operator acts on a vector of wavelengths.
#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/stages/arguments.h"
#include "kernels/stages/gather_hero.h"
#include "kernels/stages/gather_lanes.h"
#include "kernels/stages/gather_layers.h"
#include "kernels/stages/gather_walk.h"

/// A path's radiance leaves the emitter that it ended on.
static void gather_emitter(const GatherScene* scene, const GatherContext* context,
                           const VertexRecord* vertex, Lanes* radiance) {
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance[c] = vertex->emitted * emission(scene, context, vertex->emitter, c);
}

/// `radiance` holds what comes along `next` and receives what leaves the vertex.
static void gather_vertex(const GatherScene* scene, GatherContext* context, size_t slot,
                          Lanes* radiance) {
    const VertexRecord vertex = scene->vertices[slot];
    context->colour = scene->colours;
#if FEATURE_COLOURS
    context->colour += slot * VERTEX_COLOURS;
#endif
#if FEATURE_HERO
    context->lanes = vertex.material == NO_INDEX ? context->leaving : context->incoming;
#endif
    if (vertex.material == NO_INDEX) {
        gather_emitter(scene, context, &vertex, radiance);
        return;
    }
    context->material = scene->materials[vertex.material];
    context->layers = scene->layers + context->material.first_layer;
    context->lobes = scene->lobes + context->material.first_lobe;
    int lit = 0;
#if FEATURE_LIGHT_SAMPLING
    lit = vertex.light != NO_INDEX && scene->shadow_rays[slot].t_far >= 0.0f;
#endif
#if FEATURE_WALK
    if (context->material.walk != NO_INDEX) {
        context->walk_parts = scene->walk_parts + context->material.walk;
        gather_walk(scene, context, &vertex, slot, lit, radiance);
        return;
    }
#endif
    gather_layers(scene, context, &vertex, slot, lit, radiance);
}

__kernel void gather(KERNEL_SIGNATURE(GATHER_ARGUMENTS)) {
    const uint path = (uint)get_global_id(0);
    if (path >= batch.pixels * batch.samples)
        return;

    const PathState state = paths[path];
    const GatherScene scene = {.vertices = vertices,
                               .shadow_rays = shadow_rays,
                               .crossings = crossings,
                               .lobe_weights = lobe_weights,
                               .colours = colours,
                               .materials = materials,
                               .layers = layers,
                               .lobes = lobes,
                               .lights = lights,
                               .tables = tables,
                               .walk_parts = walk_parts,
                               .walk_chunks = walk_chunks,
                               .walk_vertices = walk_vertices,
                               .image_light = render.image.light,
                               .phase = state.phase,
                               .phases = render.phases};
    GatherContext context;
    context.tables = tables;
    context.phase = state.phase;
    context.phases = render.phases;
#if FEATURE_HERO
    const HeroSets sets = {hero_lanes, hero_weights, path, render.capacity};
    choose_lanes(sets, state, &scene, render);
#endif

    Lanes radiance_in[PATH_CHUNKS];
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance_in[c] = (Lanes)(0.0f);
    for (uint depth = state.vertex_count; depth-- > 0u;) {
        const size_t slot = (size_t)depth * render.capacity + path;
#if FEATURE_HERO
        load_lanes(&context, sets, slot);
#endif
        gather_vertex(&scene, &context, slot, radiance_in);
    }

#if FEATURE_HERO
    store_hero(HERO_LOAD(path, hero_lanes), radiance_in[0] * ((float)render.seen_lanes / HERO),
               radiance + (size_t)path * LANES);
#else
    for (uint c = 0u; c < CHUNKS; ++c)
        vstore16(radiance_in[c], c, radiance + (size_t)path * LANES);
#endif
}
