// The state of a walk, its connections to the light's half and its roulette (walk.h).
#ifndef RERADIANT_WALK_STATE_H
#define RERADIANT_WALK_STATE_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/scene/lights.h"
#include "kernels/walk/walk_chance.h"
#include "kernels/walk/walk_events.h"
#include "kernels/walk/walk_interface.h"
#include "kernels/walk/walk_light.h"

/// Steps that a walk makes before each one is put under roulette, and what survives it: it bounds
/// the time where nothing absorbs.
#define WALK_FREE_STEPS 200u
#define WALK_STEP_SURVIVAL 0.95f
/// Below this guess of what it carries a walk is put under roulette, and survives at least at the
/// second.
#define WALK_ROULETTE 0.5f
#define WALK_LEAST_SURVIVAL 0.05f

typedef struct {
    WalkStack stack;
    WalkPosition at;
    const WalkArrival* arrivals; ///< of the light (WALK_PLACES)
    float light_pdf;             ///< of the light's direction; 0: chance cannot meet the light
    float light_cosine;          ///< of the light's direction in air
    int is_light_far;            ///< it comes from beneath a sheet
    WalkWriter writer;
    WalkRandom random;
    real weight;
    float expected; ///< weight times what events leave of the lane that keeps most
    int is_delta;   ///< smooth surfaces alone so far
    float chance;   ///< of the event that a light met by chance is shared at (walk_chance.h)
#if FEATURE_SHEETS
    float far_chance; ///< likewise, of light beneath the sheet
#endif
    uint steps;
    uint reference; ///< which extinction distances to events in slabs are sampled with
    float log_densities[WALK_REFERENCES]; ///< of all distances so far, under each
    int by_flight; ///< the stack holds dyes: the reference may change from flight to flight
} Walk;

/// A `WalkEnd` is how a walk through a stack ended: its direction in air, and the weight of the
/// radiance that comes from there.
typedef struct {
    Vec3 direction;
    float weight; ///< 0: it ended inside
    float expected;
    float pdf; ///< what stands for that of the direction, as connections know it; -1: a delta's
} WalkEnd;

/// The balance heuristic over the extinctions that the walk might have taken (one is drawn per
/// walk): 1 where no slab scatters. Bounds the weights of lanes that scatter unlike the drawn one.
///
/// Dyes lead the light of a lane to others, of other extinctions: then one may be drawn anew at
/// every event in a slab, the sum is over all that might have been drawn so far, and it is part of
/// the weight, not of the events.
float walk_balance(const Walk* walk) {
#if FEATURE_SCATTERING_SLABS
    const float own = walk->by_flight ? 0.0f : walk->log_densities[walk->reference];
    float sum = 0.0f;
    for (uint r = 0u; r < WALK_REFERENCES; ++r)
        sum += exp(walk->log_densities[r] - own);
    return WALK_REFERENCES / sum;
#else
    return 1.0f;
#endif
}

/// Draws the extinction that the walk's next distances are sampled with.
void walk_take_reference(Walk* walk) {
#if FEATURE_SCATTERING_SLABS
    walk->reference = (uint)(walk_uniform(&walk->random) * (float)WALK_REFERENCES);
    for (uint r = 0u; r < WALK_REFERENCES; ++r)
        walk->log_densities[r] = 0.0f;
#endif
}

#if FEATURE_WALKED_DYES
/// Of events in slabs that scatter and hold dyes this share draws anew: light is seldom re-emitted
/// more than once, and a walk that keeps its extinction has weights that do not multiply.
#define WALK_REDRAWN 0.1f

/// Ends a flight with an event after which the extinction is drawn anew with probability `redrawn`.
/// What the walk then knows of its extinction is the prior of the next flight: the forward
/// algorithm of a hidden Markov chain, normalised at every event.
void walk_end_flight(Walk* walk, float redrawn) {
    const float balance = walk_balance(walk);
    walk->weight *= balance;
    for (uint r = 0u; r < WALK_REFERENCES; ++r)
        walk->log_densities[r] =
            log((1.0f - redrawn) * balance * exp(walk->log_densities[r]) + redrawn);
    if (walk_uniform(&walk->random) < redrawn)
        walk->reference = (uint)(walk_uniform(&walk->random) * (float)WALK_REFERENCES);
}
#endif

/// The walk has left upwards through a rough surface with a density, and is in the medium that it
/// left to. Light from above would have come down that way by itself.
void walk_leaves_upwards(Walk* walk, float density) {
#if FEATURE_LIGHTS_MET && FEATURE_SHEETS
    walk->far_chance =
        walk_chance_below(density, walk_ior(walk->stack, walk->at.medium), walk->at.v.z);
#endif
}

/// The walk has left a rough surface in any other way, the substrate or a scattering event.
void walk_leaves(Walk* walk, float density) {
    walk->is_delta = 0;
    walk_leaves_upwards(walk, density);
#if FEATURE_LIGHTS_MET
    walk->chance = walk_chance_below(density, walk_ior(walk->stack, walk->at.medium), walk->at.v.z);
#endif
}

/// The connection's share of the light that comes from `light` in a medium, at an event that leaves
/// towards it with the density `chance`.
float walk_connection_share(const Walk* walk, const WalkArrival* light, uint medium, float chance) {
#if FEATURE_LIGHTS_MET
    if (walk->light_pdf > 0.0f)
        return lights_mis_weight(
            walk->light_pdf,
            walk->light_cosine *
                walk_chance_below(chance, walk_ior(walk->stack, medium), light->v.z));
#endif
    return 1.0f;
}

/// Records that the light's arrival is seen from here with a density (1/sr, cosine included), and
/// with another one, `emitted`, by dyes that are recorded apart (0: by none). Returns 0 when
/// nothing is; else events of the light's way may follow.
int walk_connect_parts(Walk* walk, const WalkArrival* light, float density, float emitted) {
    const float value = walk->weight * density * light->fluence * walk_balance(walk);
    if (!(value > 0.0f))
        return 0;
    walk_write(&walk->writer, WALK_CODE(WALK_CONNECT, 0u), value);
#if FEATURE_WALKED_DYES
    if (emitted > 0.0f)
        walk_write(&walk->writer, WALK_CODE(WALK_CONNECT_EMISSION, 0u),
                   value * (emitted / density));
#endif
    for (uint k = 0u; k < walk->stack.count; ++k)
        if (light->lengths[k] > 0.0f && walk->stack.parts[k].extinction != NO_INDEX)
            walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_PASS, k), light->lengths[k]);
    for (uint i = 0u; i < light->mirrors; ++i)
        walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_REFLECT, walk->stack.count),
                   light->mirror_cosine);
    return 1;
}

int walk_connect(Walk* walk, const WalkArrival* light, float density) {
    return walk_connect_parts(walk, light, density, 0.0f);
}

/// Russian roulette by the guess of what is left, and by the number of steps.
int walk_survives(Walk* walk) {
    float survival = walk->steps > WALK_FREE_STEPS ? WALK_STEP_SURVIVAL : 1.0f;
    if (walk->expected < WALK_ROULETTE)
        survival *= fmax(walk->expected, WALK_LEAST_SURVIVAL);
    if (!(survival < 1.0f))
        return 1;
    walk->weight /= survival;
    walk->expected /= survival;
    return walk_uniform(&walk->random) < survival;
}

#endif
