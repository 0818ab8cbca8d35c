// The light's half of a walk: from a sampled light direction into the stack, and the places where
// the camera's half (walk.h) can be connected to it.
//
// Which half takes which event. Followed from the light, a path through the stack is a series of
// events at interfaces, in slabs and at the substrate. The light's half takes, from the first event
// on, every transmission downwards (through rough interfaces sampled) and every event at a smooth
// surface. The first event that is neither is the connection: a reflection by a rough interface, a
// meeting of light that comes from below with a rough interface, scattering in a slab, a diffuse or
// rough substrate. The camera's half evaluates it towards the direction in which the light arrives
// there, and takes all that follows. So every path that has a connection is counted once by
// next-event estimation; a path without any met smooth surfaces alone (what comes down through a
// rough interface must go up through it again). The camera's own direction finds paths of both
// kinds: those without a connection count in full there, the others share their light with the
// connections (walk_chance.h), which would be few and large where a rough surface is almost smooth.
//
// Light from the far side of a sheet need not turn round. There the light's half takes smooth
// surfaces alone, and the connection is its first event at anything else.
#ifndef RERADIANT_WALK_LIGHT_H
#define RERADIANT_WALK_LIGHT_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/walk/walk_interface.h"

/// A stack of `count` interfaces; parts[count] is the substrate, sheets of flakes come after it.
typedef struct {
    __global const WalkPartRecord* parts;
    __global const float* tables;
    uint count;
    float sigma;  ///< of an Oren-Nayar substrate
    int is_sheet; ///< without a substrate: beneath the last interface is air
} WalkStack;

/// Light at one place of the stack.
typedef struct {
    Vec3 v;        ///< to where it comes from, in the frame of the surface that it arrives at
    float fluence; ///< irradiance over cosine and n^2, without what depends on wavelength:
    uint mirrors;  ///< reflections by a smooth conductor
    float mirror_cosine;
    float lengths[WALK_LAYERS]; ///< in each slab, in thicknesses
} WalkArrival;

/// Places of arrival: interface k from above and from below, the substrate, slab k (which lies
/// under interface k) on the way down and on the way up, the flakes at the end of slab k.
#define WALK_AT_INTERFACE(k, down) (2u * (k) + ((down) ? 0u : 1u))
#define WALK_AT_SUBSTRATE (2u * WALK_LAYERS)
#define WALK_IN_SLAB(k, down) (2u * WALK_LAYERS + 1u + 2u * (k) + ((down) ? 0u : 1u))
#define WALK_AT_FLAKES(k, down) (4u * WALK_LAYERS + 1u + 2u * (k) + ((down) ? 0u : 1u))
#if FEATURE_TABULATED_REFLECTANCE
#define WALK_PLACES (6u * WALK_LAYERS + 1u)
#elif FEATURE_SCATTERING_SLABS
#define WALK_PLACES (4u * WALK_LAYERS + 1u)
#else
#define WALK_PLACES (2u * WALK_LAYERS + 1u)
#endif

/// A `WalkPosition` is the place of a walk: it is in medium `medium` (0: air), on its way to a
/// surface. v points back along the way, in the frame of that surface (v.z > 0).
typedef struct {
    Vec3 v;
    uint medium;
    int down;
} WalkPosition;

WalkSurface walk_surface(WalkStack stack, uint part_index, int from_below) {
    const WalkPartRecord part = stack.parts[part_index];
    const WalkSurface surface = {(int)part.distribution,
                                 part.alpha,
                                 from_below ? 1.0f / part.eta : part.eta,
                                 (int)part.multiple,
                                 part.reflectance != NO_INDEX,
                                 stack.tables + (part.cavities == NO_INDEX ? 0u : part.cavities)};
    return surface;
}

/// True for a slab where light may be scattered or re-emitted.
int walk_spreads(WalkPartRecord slab) {
#if FEATURE_WALKED_DYES
    if (slab.emission != NO_INDEX)
        return 1;
#endif
    return slab.scattering != NO_INDEX;
}

/// An interface between equal media scatters nothing, however rough.
int walk_is_rough(WalkSurface surface) {
    return surface.alpha > 0.0f && surface.eta != 1.0f;
}

uint walk_interface_ahead(WalkPosition position) {
    return position.down ? position.medium : position.medium - 1u;
}

/// Sends a walk on to the next surface along a departure, and turns v into the frame of that
/// surface.
void walk_go_on(WalkPosition* position, WalkDeparture departure) {
    position->v = vec3(-departure.direction.x, -departure.direction.y, departure.direction.z);
    if (!departure.passed)
        position->down = !position->down;
    else
        position->medium = position->down ? position->medium + 1u : position->medium - 1u;
}

float walk_ior(WalkStack stack, uint medium) {
    return medium == 0u ? 1.0f : stack.parts[medium - 1u].ior;
}

/// True in the air, above the stack or beneath a sheet.
int walk_is_outside(WalkStack stack, uint medium) {
    return medium == 0u || (stack.is_sheet && medium == stack.count);
}

/// True while something lies ahead.
int walk_has_surface_ahead(WalkStack stack, WalkPosition at) {
    return at.down ? !(stack.is_sheet && at.medium == stack.count) : at.medium > 0u;
}

void walk_clear_arrivals(WalkArrival* arrivals) {
    for (uint i = 0u; i < WALK_PLACES; ++i)
        arrivals[i].fluence = 0.0f;
}

/// Light that comes to a place more than once (between smooth surfaces) is represented by one of
/// its arrivals, picked by fluence, with the fluence of all.
void walk_arrive(WalkArrival* place, WalkArrival light, WalkRandom* random) {
    const float sum = place->fluence + light.fluence;
    if (!(place->fluence > 0.0f) || walk_uniform(random) * sum < light.fluence)
        *place = light;
    place->fluence = sum;
}

/// Takes the light down through a rough interface. `single` needs no luck to get through: the
/// reflected share is left out by weight.
WalkDeparture walk_light_through(WalkSurface surface, Vec3 v, WalkRandom* random) {
    if (surface.multiple)
        return walk_multiple(surface, v, walk_no_targets(), random);
    WalkDeparture departure = walk_departure();
    const float u1 = walk_uniform(random), u2 = walk_uniform(random);
    const Vec3 h = walk_sample_facet(surface, v, u1, u2, walk_uniform(random));
    const float cos_i = vec3_dot(v, h);
    const float reflectance = cos_i > 0.0f ? walk_reflectance(surface, cos_i) : 1.0f;
    if (!(reflectance < 1.0f))
        return departure;
    departure.direction = walk_leave_facet(surface, v, h, 1);
    departure.passed = departure.direction.z > 0.0f;
    if (departure.passed)
        departure.weight =
            (1.0f - reflectance) * walk_single_share(surface, v, h, departure.direction,
                                                     fresnel_cos_transmitted(cos_i, surface.eta));
    return departure;
}

/// The light's way at a smooth interface. From the air it takes the way into the stack: out is lost
/// to it.
WalkDeparture walk_light_smooth(WalkStack stack, WalkSurface surface, WalkPosition at,
                                WalkRandom* random) {
    WalkDeparture departure = walk_departure();
    if (!walk_is_outside(stack, at.medium))
        return walk_smooth(surface, at.v, random);
    departure.passed = 1;
    departure.weight = 1.0f - walk_reflectance(surface, at.v.z);
    departure.direction = walk_leave_facet(surface, at.v, vec3(0.0f, 0.0f, 1.0f), departure.passed);
    return departure;
}

/// Takes the light past the flakes at the end of the medium's slab, unmet, and records its arrival
/// at them.
void walk_light_pass_flakes(WalkStack stack, WalkPosition at, WalkArrival* light,
                            WalkRandom* random, WalkArrival* arrivals) {
#if FEATURE_TABULATED_REFLECTANCE
    const WalkPartRecord slab = stack.parts[at.medium - 1u];
    if (slab.flakes == NO_INDEX)
        return;
    walk_arrive(arrivals + WALK_AT_FLAKES(at.medium - 1u, at.down), *light, random);
    light->fluence *= 1.0f - slab.coverage;
#endif
}

/// Takes the light through the slab of the medium, unscattered.
void walk_light_cross(WalkStack stack, WalkPosition at, WalkArrival* light, WalkRandom* random,
                      WalkArrival* arrivals) {
    if (walk_is_outside(stack, at.medium))
        return;
    light->v = at.v;
    if (!at.down)
        walk_light_pass_flakes(stack, at, light, random, arrivals);
#if FEATURE_SCATTERING_SLABS
    if (walk_spreads(stack.parts[at.medium - 1u]))
        walk_arrive(arrivals + WALK_IN_SLAB(at.medium - 1u, at.down), *light, random);
#endif
    light->lengths[at.medium - 1u] += 1.0f / at.v.z;
    if (at.down)
        walk_light_pass_flakes(stack, at, light, random, arrivals);
}

/// Takes the light through or off an interface, and records its arrival where that is rough.
/// is_far: it comes from beneath a sheet. Returns 0 where the light's half ends.
int walk_light_meets(WalkStack stack, WalkPosition* at, int is_far, WalkArrival* light,
                     WalkRandom* random, WalkArrival* arrivals) {
    const uint k = walk_interface_ahead(*at);
    const WalkSurface surface = walk_surface(stack, k, !at->down);
    const int is_rough = walk_is_rough(surface);
    if (is_rough) {
        walk_arrive(arrivals + WALK_AT_INTERFACE(k, at->down), *light, random);
        if (!at->down || is_far)
            return 0;
    }
    const WalkDeparture departure = is_rough ? walk_light_through(surface, at->v, random)
                                             : walk_light_smooth(stack, surface, *at, random);
    if (is_rough && !departure.passed)
        return 0;
    const float flux =
        light->fluence * departure.weight * at->v.z * square(walk_ior(stack, at->medium));
    walk_go_on(at, departure);
    light->fluence = flux / (at->v.z * square(walk_ior(stack, at->medium)));
    return light->fluence > 0.0f && at->v.z > 0.0f;
}

/// Follows light from direction wi (in air, above the surface or beneath a sheet), `fluence` what
/// it brings on a plane that faces it, to all places of arrival.
void walk_light(WalkStack stack, Vec3 wi, float fluence, WalkRandom* random,
                WalkArrival* arrivals) {
    WalkPosition at = {wi, 0u, 1};
    WalkArrival light;
    const int is_far = FEATURE_SHEETS && wi.z < 0.0f;
    if (is_far) {
        at.v = walk_mirrored(wi);
        at.medium = stack.count;
        at.down = 0;
    }
    light.v = at.v;
    light.fluence = fluence;
    light.mirrors = 0u;
    light.mirror_cosine = 0.0f;
    for (uint k = 0u; k < WALK_LAYERS; ++k)
        light.lengths[k] = 0.0f;
    while (walk_has_surface_ahead(stack, at)) {
        if (at.down && at.medium == stack.count) {
            const WalkPartRecord substrate = stack.parts[stack.count];
            if (substrate.reflectance == NO_INDEX || substrate.alpha > 0.0f) {
                walk_arrive(arrivals + WALK_AT_SUBSTRATE, light, random);
                return;
            }
            ++light.mirrors;
            light.mirror_cosine = at.v.z;
            at.down = 0; // mirrored twice, into the frame of the surface above: v stays
        } else if (!walk_light_meets(stack, &at, is_far, &light, random, arrivals)) {
            return;
        }
        walk_light_cross(stack, at, &light, random, arrivals);
    }
}

#endif
