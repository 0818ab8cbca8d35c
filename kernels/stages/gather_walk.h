// Replays the events of a walk through a stack on all lanes (walk_events.h).
#ifndef RERADIANT_GATHER_WALK_H
#define RERADIANT_GATHER_WALK_H

#include "kernels/stages/gather_lanes.h"
#include "kernels/stages/gather_substrate.h"
#include "kernels/walk/walk_events.h"

#if FEATURE_WALK
/// exp(-(depth - sampled) length) of a slab for one vector of lanes, times its scattering where it
/// scattered.
Lanes walk_slab_lanes(const GatherContext* context, WalkPartRecord part, float sampled,
                      float length, int scattered, uint chunk) {
    const uint lanes = context->phase * LANES;
    const Lanes depth = path_row(context, context->tables + part.extinction + lanes, chunk);
    const Lanes passed = exp((sampled - depth) * length);
#if FEATURE_SCATTERING_SLABS
    if (scattered)
        return passed * path_row(context, context->tables + part.scattering + lanes, chunk) /
               sampled;
#endif
    return passed;
}

/// L = M L; the material's operator is M / pi.
void walk_substrate(const GatherContext* context, Lanes* radiance) {
    Lanes emitted[PATH_CHUNKS];
    substrate(context, radiance, radiance, emitted);
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance[c] = (float)PI_REAL * emitted[c];
}

/// Returns the factors by which one event multiplies the lanes of `light` or of the path.
Lanes walk_event_lanes(const GatherContext* context, WalkEvent event, uint reference, uint chunk) {
    const uint kind = WALK_KIND(event.code);
    const WalkPartRecord part = context->walk_parts[WALK_INDEX(event.code)];
#if FEATURE_TABULATED_REFLECTANCE
    if (kind == WALK_REFLECT || kind == WALK_LIGHT_REFLECT)
        return facet_reflectance(context, part.reflectance, event.value, chunk);
    if (kind == WALK_BOUNCE || kind == WALK_LIGHT_BOUNCE)
        return path_row(context, context->tables + part.bounced + context->phase * LANES, chunk);
#endif
    const float sampled = kind == WALK_LIGHT_PASS ? 0.0f : part.references[reference];
    return walk_slab_lanes(context, part, sampled, event.value, kind == WALK_SCATTER, chunk);
}

/// Replays a walk from its last event to its first: `radiance` holds what comes in along the
/// path's next direction (weight included) and receives what leaves towards the camera; `light` is
/// the spectrum of the light that connections see.
void replay_walk(const GatherContext* context, WalkReader reader, uint reference, int lit,
                 const Lanes* light, Lanes* radiance) {
    Lanes seen[PATH_CHUNKS];
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        seen[c] = light[c];
    WalkEvent event;
    while (walk_read(&reader, &event)) {
        const uint kind = WALK_KIND(event.code);
        if (kind == WALK_SUBSTRATE) {
            walk_substrate(context, radiance);
            continue;
        }
        for (uint c = 0u; c < PATH_CHUNKS; ++c) {
            if (kind == WALK_CONNECT) {
                if (lit)
                    radiance[c] += event.value * seen[c];
                seen[c] = light[c];
            } else if (kind < WALK_CONNECT) {
                radiance[c] *= walk_event_lanes(context, event, reference, c);
            } else if (lit) {
                seen[c] *= walk_event_lanes(context, event, reference, c);
            }
        }
    }
}

/// Radiance that leaves a vertex which was walked through; `radiance` as in gather_layers.
static void gather_walk(const GatherScene* scene, const GatherContext* context,
                        const VertexRecord* vertex, size_t slot, int lit, Lanes* radiance) {
    const WalkVertexRecord walk = scene->walk_vertices[slot];
    Lanes light[PATH_CHUNKS];
    const float weight = vertex->has_next ? walk.weight : 0.0f;
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        radiance[c] = weight > 0.0f ? weight * radiance[c] : (Lanes)(0.0f);
        light[c] = lit ? light_found(scene, context, vertex->light, slot, c) : (Lanes)(0.0f);
    }
    const WalkReader reader = {scene->walk_chunks, walk.chunk, walk.count};
    replay_walk(context, reader, walk.reference, lit, light, radiance);
}
#endif

#endif
