// A walk through a slab that scatters, or holds dyes that re-emit what they absorb.
#ifndef RERADIANT_WALK_SLAB_H
#define RERADIANT_WALK_SLAB_H

#include "kernels/core/features.h"
#include "kernels/scatter/henyey_greenstein.h"
#include "kernels/walk/walk_state.h"

#if FEATURE_SCATTERING_SLABS
/// What an event in a slab may be: scattering, emission by dyes, or both at once. Its direction is
/// drawn from the mixture of both by `emission`, the share of emission.
typedef struct {
    float anisotropy; ///< of scattering
    float emission;
} WalkPhase;

WalkPhase walk_phase(WalkPartRecord part) {
    const WalkPhase phase = {
        part.anisotropy,
#if FEATURE_WALKED_DYES
        part.emission == NO_INDEX ? 0.0f : part.emission_share
#else
        0.0f
#endif
    };
    return phase;
}

/// Density of the mixture, 1/sr, of which `scattered` is that of scattering.
float walk_mixed_density(WalkPhase phase, float scattered) {
#if FEATURE_WALKED_DYES
    return (1.0f - phase.emission) * scattered + phase.emission * (0.25f * INV_PI_REAL);
#else
    return scattered;
#endif
}

/// Connects an event at a height (0: top of the slab, 1: its end) to the light that passes there;
/// back: where the walk comes from.
void walk_connect_in_slab(Walk* walk, uint k, float height, Vec3 back, WalkPhase phase) {
    for (int down = 0; down < 2; ++down) {
        const WalkArrival* light = walk->arrivals + WALK_IN_SLAB(k, down);
        if (!(light->fluence > 0.0f))
            continue;
        const Vec3 l = down ? light->v : walk_mirrored(light->v);
        // light comes along -l and leaves along `back`
        const float scattered = henyey_greenstein_phase(phase.anisotropy, -vec3_dot(l, back));
        const float share = walk_connection_share(walk, light, walk->at.medium,
                                                  walk_mixed_density(phase, scattered));
        const float emitted = 0.25f * INV_PI_REAL * share;
        const int is_mixed = phase.emission > 0.0f && phase.emission < 1.0f;
        if (walk_connect_parts(walk, light, phase.emission < 1.0f ? scattered * share : emitted,
                               is_mixed ? emitted : 0.0f))
            walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_PASS, k),
                       (down ? height : 1.0f - height) / light->v.z);
    }
}

/// Counts a way of some length in a slab, with an event at its end or not, under every extinction.
void walk_count_distance(Walk* walk, WalkPartRecord part, float length, int has_event) {
    for (uint r = 0u; r < WALK_REFERENCES; ++r)
        walk->log_densities[r] +=
            (has_event ? log(part.references[r]) : 0.0f) - part.references[r] * length;
}

/// Sends the walk on from an event, and records by which weights the parts of the event share the
/// light that comes from there.
void walk_leave_event(Walk* walk, uint k, Vec3 back, WalkPhase phase) {
    float anisotropy = phase.anisotropy;
#if FEATURE_WALKED_DYES
    if (phase.emission > 0.0f && walk_uniform(&walk->random) < phase.emission)
        anisotropy = 0.0f;
#endif
    const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
    const Vec3 w = henyey_greenstein_sample(vec3_scale(back, -1.0f), anisotropy, u1, u2);
    const float scattered = henyey_greenstein_phase(phase.anisotropy, -vec3_dot(w, back));
    const float density = walk_mixed_density(phase, scattered);
    walk->at.down = w.z < 0.0f;
    walk->at.v = vec3(-w.x, -w.y, fabs(w.z));
    walk_leaves(walk, density);
#if FEATURE_WALKED_DYES
    if (phase.emission > 0.0f && phase.emission < 1.0f)
        walk_write(&walk->writer, WALK_CODE(WALK_MIX, k), scattered / density);
#endif
}

/// Takes the walk through a slab that scatters or holds dyes, from one of its ends to one of its
/// ends. Returns 0 where the walk ends inside.
int walk_scatter_in_slab(Walk* walk, uint k, WalkPartRecord part) {
    const WalkPhase phase = walk_phase(part);
    float height = walk->at.down ? 0.0f : 1.0f;
    for (;;) {
        const float to_end = (walk->at.down ? 1.0f - height : height) / walk->at.v.z;
        const float length =
            -log1p(-walk_uniform(&walk->random)) / part.references[walk->reference];
        if (!(length < to_end)) {
            walk_write_pass(&walk->writer, k, to_end);
            walk_count_distance(walk, part, to_end, 0);
            return 1;
        }
        height += (walk->at.down ? length : -length) * walk->at.v.z;
        walk_write(&walk->writer, WALK_CODE(phase.emission > 0.0f ? WALK_EMIT : WALK_SCATTER, k),
                   length);
        walk_count_distance(walk, part, length, 1);
#if FEATURE_WALKED_DYES
        if (walk->by_flight)
            walk_end_flight(walk, phase.emission > 0.0f && phase.emission < 1.0f ? WALK_REDRAWN
                                                                                 : phase.emission);
#endif
        const Vec3 back = walk->at.down ? walk->at.v : walk_mirrored(walk->at.v);
        walk_connect_in_slab(walk, k, height, back, phase);
        walk_leave_event(walk, k, back, phase);
        walk->expected *= part.albedo;
        ++walk->steps;
        if (!(walk->at.v.z > 0.0f) || !walk_survives(walk))
            return 0;
    }
}
#endif

#endif
