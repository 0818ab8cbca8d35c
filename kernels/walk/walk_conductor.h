// A walk meets a conductor: the substrate, or a flake in a slab.
#ifndef RERADIANT_WALK_CONDUCTOR_H
#define RERADIANT_WALK_CONDUCTOR_H

#include "kernels/core/features.h"
#include "kernels/walk/walk_state.h"

#if FEATURE_TABULATED_REFLECTANCE
/// A rough conductor (substrate or flake) that the walk meets: its part, and the light there.
typedef struct {
    WalkSurface surface;
    uint part;
    const WalkArrival* light;
    float share; ///< of the light's radiance that is left to connections
} WalkMirror;

/// A facet of a conductor reflects into the light's direction.
void walk_connect_by_facet(Walk* walk, WalkMirror mirror, Vec3 v, float density) {
    if (walk_connect(walk, mirror.light, density * mirror.share))
        walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_REFLECT, mirror.part),
                   vec3_dot(v, walk_half_reflected(v, mirror.light->v)));
}

void walk_reflect_by_facet(Walk* walk, uint part, float cosine) {
    walk_write(&walk->writer, WALK_CODE(WALK_REFLECT, part), cosine);
    walk->expected *= walk->stack.parts[part].albedo;
}

void walk_connect_one_facet(Walk* walk, WalkMirror mirror) {
    const Vec3 v = walk->at.v, l = mirror.light->v;
    if (mirror.light->fluence > 0.0f)
        walk_connect_by_facet(walk, mirror, v, walk_single_reflection(mirror.surface, v, l, 1.0f));
}

int walk_reflect_by_one_facet(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    const Vec3 v = walk->at.v;
    const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
    const Vec3 h = walk_sample_facet(mirror.surface, v, u1, u2, walk_uniform(&walk->random));
    const float cos_i = vec3_dot(v, h);
    departure->direction = walk_reflected(v, h);
    if (!(cos_i > 0.0f) || !(departure->direction.z > 0.0f))
        return 0;
    walk->weight *= walk_single_share(mirror.surface, v, h, departure->direction, cos_i);
    walk_reflect_by_facet(walk, mirror.part, cos_i);
    return 1;
}

/// One facet of a rough conductor.
int walk_single_conductor(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    walk_connect_one_facet(walk, mirror);
    return walk_reflect_by_one_facet(walk, mirror, departure);
}

/// V-cavities of a conductor: one facet, or what they lose given back.
int walk_cavity_conductor(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    const float cosine = walk->at.v.z, lost = walk_cavity_lost(mirror.surface, 0, cosine);
    walk_connect_one_facet(walk, mirror);
    if (walk_connect(walk, mirror.light,
                     mirror.share *
                         walk_cavity_density(mirror.surface, cosine, 0, mirror.light->v.z)))
        walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_BOUNCE, mirror.part), 0.0f);
    if (!(walk_uniform(&walk->random) < lost)) {
        walk->weight /= 1.0f - lost;
        return walk_reflect_by_one_facet(walk, mirror, departure);
    }
    const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
    int passed;
    departure->direction =
        walk_cavity_departure(mirror.surface, u1, u2, walk_uniform(&walk->random), &passed);
    walk_write(&walk->writer, WALK_CODE(WALK_BOUNCE, mirror.part), 0.0f);
    walk->expected *= walk->stack.parts[mirror.part].albedo;
    return 1;
}

/// The walk between the facets of a conductor.
int walk_smith_conductor(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    WalkBetweenFacets facets =
        walk_between_facets(mirror.surface, walk->at.v, walk_uniform(&walk->random));
    for (;;) {
        if (mirror.light->fluence > 0.0f)
            walk_connect_by_facet(walk, mirror, facets.v,
                                  walk_density_back(&facets, mirror.light->v));
        const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
        const Vec3 h =
            microfacet_sample(mirror.surface.distribution, mirror.surface.alpha, facets.v, u1, u2);
        const float cos_i = vec3_dot(facets.v, h);
        if (!(cos_i > 0.0f))
            return 0;
        walk_reflect_by_facet(walk, mirror.part, cos_i);
        if (!walk_late_survives(facets.order, &walk->random, &walk->weight))
            return 0;
        if (walk_to_next_facet(&facets, h, 0, walk_uniform(&walk->random), &departure->direction))
            return 1;
    }
}

int walk_rough_conductor(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    if (mirror.light->fluence > 0.0f)
        mirror.share = walk_connection_share(
            walk, mirror.light, walk->at.medium,
            walk_chance_at_facets(mirror.surface, walk->at.v, mirror.light->v, 0));
    if (!mirror.surface.multiple)
        return walk_single_conductor(walk, mirror, departure);
    return mirror.surface.distribution == MICROFACET_BLINN
               ? walk_cavity_conductor(walk, mirror, departure)
               : walk_smith_conductor(walk, mirror, departure);
}

/// A conductor, lit from `place`.
int walk_meets_conductor(Walk* walk, uint part, uint place) {
    const WalkMirror mirror = {walk_surface(walk->stack, part, 0), part, walk->arrivals + place,
                               1.0f};
    const Vec3 v = walk->at.v;
    const int is_rough = mirror.surface.alpha > 0.0f;
    WalkDeparture departure = walk_departure();
    if (!is_rough) {
        departure.direction = vec3(-v.x, -v.y, v.z);
        walk_reflect_by_facet(walk, part, v.z);
    } else if (!walk_rough_conductor(walk, mirror, &departure)) {
        return 0;
    }
    walk_go_on(&walk->at, departure);
    if (!(walk->weight > 0.0f && walk->at.v.z > 0.0f))
        return 0;
    if (is_rough)
        walk_leaves(walk, walk_chance_at_facets(mirror.surface, v, departure.direction, 0));
    return walk_survives(walk);
}

/// Returns whether the walk meets a flake where it comes to the end of its slab, or sets out from
/// there: at random, by the share of the area that flakes cover.
int walk_finds_flake(Walk* walk) {
    const uint slab = walk->at.medium - 1u;
    return walk->stack.parts[slab].flakes != NO_INDEX &&
           walk_uniform(&walk->random) < walk->stack.parts[slab].coverage;
}

int walk_meets_flake(Walk* walk) {
    const uint slab = walk->at.medium - 1u;
    ++walk->steps;
    return walk_meets_conductor(walk, walk->stack.parts[slab].flakes,
                                WALK_AT_FLAKES(slab, walk->at.down));
}
#endif

#endif
