// Replays the events of a walk through a stack on all lanes (walk_events.h).
#ifndef RERADIANT_GATHER_WALK_H
#define RERADIANT_GATHER_WALK_H

#include "kernels/stages/gather_lanes.h"
#include "kernels/stages/gather_substrate.h"
#include "kernels/walk/walk_events.h"

#if FEATURE_WALK
/// exp(-(depth - sampled) length) of a slab for one vector of lanes, times its scattering over
/// `sampled` where it scattered; `sampled` 0: the weights of the events know.
Lanes walk_slab_lanes(const GatherContext* context, WalkPartRecord part, float sampled,
                      float length, int scattered, uint chunk) {
    const uint lanes = context->phase * LANES;
    const Lanes depth = path_row(context, context->tables + part.extinction + lanes, chunk);
    const Lanes passed = exp((sampled - depth) * length);
#if FEATURE_SCATTERING_SLABS
    if (scattered)
        return passed * path_row(context, context->tables + part.scattering + lanes, chunk) /
               (sampled > 0.0f ? sampled : 1.0f);
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

#define WALK_RE_EMITS (FEATURE_WALKED_DYES && !FEATURE_HERO) // hero sets are not walked

/// A `WalkReplay` is what a replayed walk has come to: the radiance that comes in along it, the
/// spectrum of the light that the next connection sees, and the radiance that dyes receive where it
/// is another (WALK_MIX).
typedef struct {
    Lanes radiance[PATH_CHUNKS], seen[PATH_CHUNKS];
#if WALK_RE_EMITS
    Lanes received[PATH_CHUNKS];
    int is_mixed;
#endif
} WalkReplay;

#if WALK_RE_EMITS
/// Makes the L of dyes of the one that comes in.
void walk_mix(const GatherContext* context, WalkEvent event, WalkReplay* replay) {
    const float share = context->walk_parts[WALK_INDEX(event.code)].emission_share;
    const float emitted = fmax((1.0f - (1.0f - share) * event.value) / share, 0.0f);
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        replay->received[c] = emitted * replay->radiance[c];
        replay->radiance[c] *= event.value;
    }
    replay->is_mixed = 1;
}

/// L = (scattering L + emission L) exp(-depth length).
void walk_emission(const GatherContext* context, WalkEvent event, WalkReplay* replay) {
    const WalkPartRecord part = context->walk_parts[WALK_INDEX(event.code)];
    Lanes sent[PATH_CHUNKS];
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        sent[c] = (Lanes)(0.0f);
    reradiation_dense(replay->is_mixed ? replay->received : replay->radiance, sent,
                      context->tables + part.emission + (size_t)context->phase * (LANES * LANES));
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        sent[c] *= walk_slab_lanes(context, part, 0.0f, event.value, 0, c);
        if (replay->is_mixed)
            sent[c] +=
                replay->radiance[c] * walk_slab_lanes(context, part, 0.0f, event.value, 1, c);
        replay->radiance[c] = sent[c];
    }
    replay->is_mixed = 0;
}

/// Replays an event of dyes; returns 0 for any other.
int walk_replay_dyes(const GatherContext* context, WalkEvent event, int lit, WalkReplay* replay) {
    const uint kind = WALK_KIND(event.code);
    if (kind == WALK_EMIT)
        walk_emission(context, event, replay);
    else if (kind == WALK_MIX)
        walk_mix(context, event, replay);
    else if (kind == WALK_CONNECT_EMISSION)
        for (uint c = 0u; lit && c < PATH_CHUNKS; ++c)
            replay->received[c] += event.value * replay->seen[c];
    else
        return 0;
    return 1;
}
#endif

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
    const int is_sampled = kind != WALK_LIGHT_PASS && reference != NO_INDEX;
    return walk_slab_lanes(context, part, is_sampled ? part.references[reference] : 0.0f,
                           event.value, kind == WALK_SCATTER, chunk);
}

/// Replays a walk from its last event to its first: replay->radiance holds what comes in along the
/// path's next direction (weight included) and receives what leaves towards the camera; `light` is
/// the spectrum of the light that connections see.
void replay_walk(const GatherContext* context, WalkReader reader, uint reference, int lit,
                 const Lanes* light, WalkReplay* replay) {
    WalkEvent event;
    while (walk_read(&reader, &event)) {
        const uint kind = WALK_KIND(event.code);
        if (kind == WALK_SUBSTRATE) {
            walk_substrate(context, replay->radiance);
            continue;
        }
#if WALK_RE_EMITS
        if (walk_replay_dyes(context, event, lit, replay))
            continue;
#endif
        for (uint c = 0u; c < PATH_CHUNKS; ++c) {
            if (kind == WALK_CONNECT) {
                if (lit)
                    replay->radiance[c] += event.value * replay->seen[c];
                replay->seen[c] = light[c];
            } else if (kind < WALK_CONNECT) {
                replay->radiance[c] *= walk_event_lanes(context, event, reference, c);
            } else if (lit) {
                replay->seen[c] *= walk_event_lanes(context, event, reference, c);
            }
        }
    }
}

/// Radiance that leaves a vertex which was walked through; `radiance` as in gather_layers.
static void gather_walk(const GatherScene* scene, const GatherContext* context,
                        const VertexRecord* vertex, size_t slot, int lit, Lanes* radiance) {
    const WalkVertexRecord walk = scene->walk_vertices[slot];
    Lanes light[PATH_CHUNKS];
    WalkReplay replay;
    const float weight = vertex->has_next ? walk.weight : 0.0f;
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        replay.radiance[c] = weight > 0.0f ? weight * radiance[c] : (Lanes)(0.0f);
        light[c] = lit ? light_found(scene, context, vertex->light, slot, c) : (Lanes)(0.0f);
        replay.seen[c] = light[c];
    }
#if WALK_RE_EMITS
    replay.is_mixed = 0;
#endif
    const WalkReader reader = {scene->walk_chunks, walk.chunk, walk.count};
    replay_walk(context, reader, walk.reference, lit, light, &replay);
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance[c] = replay.radiance[c];
}
#endif

#endif
