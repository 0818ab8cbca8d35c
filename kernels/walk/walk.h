// The model `walk`: a position-free random walk through a stack of interfaces and slabs (after Guo,
// Hasan and Zhao 2018), from the camera's direction down and back to the air. Which paths it counts
// by looking for a light and which by finding one is told in walk_light.h.
//
// The walk is scalar: directions, and weights of what does not depend on wavelength. What does is
// recorded as events (walk_events.h), which `gather` replays backwards on all lanes at once, so
// that re-radiation acts inside the walk at the cost of one operator a meeting. Interfaces are
// walked through with reciprocal scattering as if the camera sent light: directions then follow f
// cos for radiance that comes back, the factors n^2 of refraction cancel between air and air, and
// for a connection below are in the light's fluence.
#ifndef RERADIANT_WALK_H
#define RERADIANT_WALK_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/sampling.h"
#include "kernels/core/shared.h"
#include "kernels/scatter/oren_nayar.h"
#include "kernels/walk/walk_conductor.h"
#include "kernels/walk/walk_slab.h"
#include "kernels/walk/walk_state.h"

/// Connects an interface that the walk stands at to light on this side or beyond.
void walk_connect_at_facets(Walk* walk, WalkSurface surface, const WalkArrival* light, int beyond,
                            float density) {
    const uint next = walk->at.down ? walk->at.medium + 1u : walk->at.medium - 1u;
    const uint medium = beyond ? next : walk->at.medium;
    // only the walk between Smith's facets has another density than that of its first facet
    const int is_smith = surface.multiple && surface.distribution != MICROFACET_BLINN;
    const float chance =
        is_smith ? walk_chance_at_facets(surface, walk->at.v, light->v, beyond) : density;
    walk_connect(walk, light, density * walk_connection_share(walk, light, medium, chance));
}

/// An interface; returns 0 where the walk ends.
int walk_meets_interface(Walk* walk) {
    const uint k = walk_interface_ahead(walk->at);
    const int down = walk->at.down;
    const WalkSurface surface = walk_surface(walk->stack, k, !down);
    const WalkArrival* above = walk->arrivals + WALK_AT_INTERFACE(k, 1);
    const WalkArrival* below = walk->arrivals + WALK_AT_INTERFACE(k, 0);
    const WalkArrival* same = down ? above : below;
    const WalkArrival* beyond = down ? below : above;
    WalkTargets targets = walk_no_targets();
    const int is_rough = walk_is_rough(surface);
    if (is_rough) {
        targets.has_same = same->fluence > 0.0f;
        // on the way up light from above comes down by itself
        targets.has_beyond = (down || walk->is_light_far) && beyond->fluence > 0.0f;
        targets.same = same->v;
        targets.beyond = beyond->v;
    }
    const Vec3 v = walk->at.v;
    const WalkDeparture departure = walk_interface(surface, v, targets, &walk->random);
    if (targets.has_same)
        walk_connect_at_facets(walk, surface, same, 0, departure.same_density);
    if (targets.has_beyond)
        walk_connect_at_facets(walk, surface, beyond, 1, departure.beyond_density);
    walk->weight *= departure.weight;
    walk_go_on(&walk->at, departure);
    if (!(walk->weight > 0.0f && walk->at.v.z > 0.0f))
        return 0;
    if (is_rough) {
        const float chance =
            walk_chance_at_facets(surface, v, departure.direction, departure.passed);
        if (down || !departure.passed)
            walk_leaves(walk, chance);
        else
            walk_leaves_upwards(walk, chance);
    }
    return 1;
}

/// A diffuse substrate: M is an event, cos / pi or Oren and Nayar's shape are weights.
int walk_meets_diffuse(Walk* walk) {
    const WalkArrival* light = walk->arrivals + WALK_AT_SUBSTRATE;
    const Vec3 v = walk->at.v;
    const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
    WalkDeparture departure = walk_departure();
    departure.direction = sampling_cosine(u1, u2);
    float towards_light = INV_PI_REAL;
#if FEATURE_OREN_NAYAR
    if (walk->stack.sigma > 0.0f) {
        towards_light = oren_nayar_value(walk->stack.sigma, light->v, v);
        departure.weight = PI_REAL * oren_nayar_value(walk->stack.sigma, departure.direction, v);
    }
#endif
    walk_write(&walk->writer, WALK_CODE(WALK_SUBSTRATE, 0u), 1.0f);
    if (light->fluence > 0.0f)
        walk_connect(
            walk, light,
            towards_light * light->v.z *
                walk_connection_share(walk, light, walk->at.medium, INV_PI_REAL * light->v.z));
    walk->weight *= departure.weight;
    walk->expected *= departure.weight * walk->stack.parts[walk->stack.count].albedo;
    walk_go_on(&walk->at, departure);
    walk_leaves(walk, INV_PI_REAL * walk->at.v.z);
    return walk->weight > 0.0f && walk->at.v.z > 0.0f && walk_survives(walk);
}

/// Takes the walk through the slab of the medium to its end; returns 0 where it ends inside.
int walk_cross_slab(Walk* walk) {
    const uint k = walk->at.medium - 1u;
    const WalkPartRecord part = walk->stack.parts[k];
#if FEATURE_SCATTERING_SLABS
    if (walk_spreads(part))
        return walk_scatter_in_slab(walk, k, part);
#endif
    if (part.extinction != NO_INDEX) {
        walk_write_pass(&walk->writer, k, 1.0f / walk->at.v.z);
        walk->expected *= exp(-part.least_depth / walk->at.v.z);
    }
    return 1;
}

/// Takes the walk on to the next interface or the substrate, through the medium's slab and the
/// flakes at its lower end; returns 0 where it ends on the way.
int walk_cross(Walk* walk) {
    if (walk_is_outside(walk->stack, walk->at.medium))
        return 1;
#if FEATURE_TABULATED_REFLECTANCE
    if (!walk->at.down && walk_finds_flake(walk))
        return walk_meets_flake(walk);
    for (;;) {
        if (!walk_cross_slab(walk))
            return 0;
        if (!walk->at.down || !walk_finds_flake(walk))
            return 1;
        if (!walk_meets_flake(walk))
            return 0;
    }
#else
    return walk_cross_slab(walk);
#endif
}

int walk_meets_substrate(Walk* walk) {
#if FEATURE_TABULATED_REFLECTANCE
    if (walk->stack.parts[walk->stack.count].reflectance != NO_INDEX)
        return walk_meets_conductor(walk, walk->stack.count, WALK_AT_SUBSTRATE);
#endif
    return walk_meets_diffuse(walk);
}

/// The walk of a camera that looks along -wo (wo above the surface), connected to `arrivals`.
WalkEnd walk_stack(Walk* walk, Vec3 wo) {
    walk->at.v = wo;
    walk->at.medium = 0u;
    walk->at.down = 1;
    walk->weight = walk->expected = 1.0f;
    walk->is_delta = 1;
    walk->chance = 0.0f;
#if FEATURE_SHEETS
    walk->far_chance = 0.0f;
#endif
    walk->reference = 0u;
    walk->by_flight = 0;
#if FEATURE_WALKED_DYES
    for (uint k = 0u; k < walk->stack.count; ++k)
        walk->by_flight |= walk->stack.parts[k].emission != NO_INDEX;
#endif
    walk_take_reference(walk);
    WalkEnd end = {vec3(0.0f, 0.0f, 1.0f), 0.0f, 0.0f, 0.0f};
    for (walk->steps = 0u; walk_has_surface_ahead(walk->stack, walk->at); ++walk->steps) {
        const int goes_on = walk->at.down && walk->at.medium == walk->stack.count
                                ? walk_meets_substrate(walk)
                                : walk_meets_interface(walk);
        if (!goes_on || !walk_cross(walk))
            return end;
    }
    end.direction = vec3(-walk->at.v.x, -walk->at.v.y, walk->at.v.z);
    end.weight = walk->weight * walk_balance(walk);
    end.expected = walk->expected;
    end.pdf = walk->chance * walk->at.v.z;
#if FEATURE_SHEETS
    if (walk->at.down) {
        end.direction.z = -walk->at.v.z;
        end.pdf = walk->far_chance * walk->at.v.z;
    }
#endif
    if (walk->is_delta)
        end.pdf = -1.0f;
    return end;
}

#endif
