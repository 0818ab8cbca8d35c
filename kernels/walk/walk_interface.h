// One meeting of a random walk with an interface: which way it leaves, and the density with which
// it could have left towards given directions (for next-event estimation). Flux in, flux out: the
// weights have the directional-hemispherical shares of host/layers/rough/interface_walk.h as
// expectation.
#ifndef RERADIANT_WALK_INTERFACE_H
#define RERADIANT_WALK_INTERFACE_H

#include "kernels/core/portable.h"
#include "kernels/core/random.h"
#include "kernels/walk/walk_cavities.h"
#include "kernels/walk/walk_facets.h"
#include "kernels/walk/walk_microsurface.h"

KERNELS_BEGIN

/// Uniform numbers of one walk, as many as it takes.
typedef struct {
    uint pixel, sample, dimension, seed;
    uint left; ///< of `numbers`
    Random4 numbers;
} WalkRandom;

DEVICE_FUNCTION WalkRandom walk_random(uint pixel, uint sample, uint dimension, uint seed) {
    WalkRandom random;
    random.pixel = pixel;
    random.sample = sample;
    random.dimension = dimension;
    random.seed = seed;
    random.left = 0u;
    random.numbers.a = random.numbers.b = random.numbers.c = random.numbers.d = REAL(0.0);
    return random;
}

DEVICE_FUNCTION real walk_uniform(WalkRandom* random) {
    if (random->left == 0u) {
        random->numbers =
            random_4(random->pixel, random->sample, random->dimension++, random->seed);
        random->left = 4u;
    }
    {
        const uint i = random->left--;
        return i == 4u   ? random->numbers.a
               : i == 3u ? random->numbers.b
               : i == 2u ? random->numbers.c
                         : random->numbers.d;
    }
}

/// Directions that scattering is evaluated towards: on the side of arrival and beyond, each in its
/// own frame.
typedef struct {
    Vec3 same, beyond;
    int has_same, has_beyond;
} WalkTargets;

/// A `WalkDeparture` is how a walk left an interface: its direction, in the frame of the side that
/// it left to, and its weight, 0 when nothing left. The densities (1/sr, cosine of the target
/// included) are those of leaving towards the targets.
typedef struct {
    Vec3 direction;
    int passed; ///< beyond the interface
    real weight;
    real same_density, beyond_density;
} WalkDeparture;

DEVICE_FUNCTION WalkTargets walk_no_targets(void) {
    WalkTargets targets;
    targets.same = targets.beyond = vec3(REAL(0.0), REAL(0.0), REAL(1.0));
    targets.has_same = targets.has_beyond = 0;
    return targets;
}

DEVICE_FUNCTION WalkDeparture walk_departure(void) {
    WalkDeparture departure;
    departure.direction = vec3(REAL(0.0), REAL(0.0), REAL(1.0));
    departure.passed = 0;
    departure.weight = REAL(1.0);
    departure.same_density = departure.beyond_density = REAL(0.0);
    return departure;
}

/// Reflection or refraction at one facet of normal h. The frame of the medium beyond is the mirror
/// image of this one.
DEVICE_FUNCTION Vec3 walk_leave_facet(WalkSurface surface, Vec3 v, Vec3 h, int passes) {
    return passes ? walk_mirrored(walk_refracted(v, h, surface.eta)) : walk_reflected(v, h);
}

/// Reflects or refracts a walk at a smooth interface. There are no densities: a delta has none.
DEVICE_FUNCTION WalkDeparture walk_smooth(WalkSurface surface, Vec3 v, WalkRandom* random) {
    WalkDeparture departure = walk_departure();
    departure.passed = !(walk_uniform(random) < walk_reflectance(surface, v.z));
    departure.direction =
        walk_leave_facet(surface, v, vec3(REAL(0.0), REAL(0.0), REAL(1.0)), departure.passed);
    return departure;
}

/// Density of `single` towards w, which is in the frame of its side, beyond the interface where
/// `passed`: that of the facets times their masking, 1/sr with the cosine of w.
DEVICE_FUNCTION real walk_single_density(WalkSurface surface, Vec3 v, Vec3 w, int passed) {
    if (passed) {
        const Vec3 beyond = walk_mirrored(w);
        const WalkRefraction r = walk_refraction(surface, v, beyond);
        return walk_single_refraction(surface, v, beyond, r,
                                      REAL(1.0) - walk_reflectance(surface, r.cos_i));
    }
    return walk_single_reflection(
        surface, v, w, walk_reflectance(surface, vec3_dot(v, walk_half_reflected(v, w))));
}

/// Densities of `single` towards the targets.
DEVICE_FUNCTION void walk_single_densities(WalkSurface surface, Vec3 v, WalkTargets targets,
                                           WalkDeparture* departure) {
    if (targets.has_same)
        departure->same_density = walk_single_density(surface, v, targets.same, 0);
    if (targets.has_beyond)
        departure->beyond_density = walk_single_density(surface, v, targets.beyond, 1);
}

/// Reflects or refracts a walk at one facet; what other facets mask is lost (Walter et al. 2007).
/// No densities are set.
DEVICE_FUNCTION WalkDeparture walk_one_facet(WalkSurface surface, Vec3 v, WalkRandom* random) {
    WalkDeparture departure = walk_departure();
    const real u1 = walk_uniform(random), u2 = walk_uniform(random);
    const Vec3 h = walk_sample_facet(surface, v, u1, u2, walk_uniform(random));
    const real cos_i = vec3_dot(v, h);
    departure.weight = REAL(0.0);
    if (!(cos_i > REAL(0.0)))
        return departure;
    departure.passed = !(walk_uniform(random) < walk_reflectance(surface, cos_i));
    departure.direction = walk_leave_facet(surface, v, h, departure.passed);
    if (departure.direction.z > REAL(0.0)) {
        const real cos_w = departure.passed ? fresnel_cos_transmitted(cos_i, surface.eta) : cos_i;
        departure.weight = walk_single_share(surface, v, h, departure.direction, cos_w);
    }
    return departure;
}

DEVICE_FUNCTION WalkDeparture walk_single(WalkSurface surface, Vec3 v, WalkTargets targets,
                                          WalkRandom* random) {
    WalkDeparture departure = walk_one_facet(surface, v, random);
    walk_single_densities(surface, v, targets, &departure);
    return departure;
}

/// Reflects or refracts a walk at one facet of V-cavities, or gives back what they lose.
DEVICE_FUNCTION WalkDeparture walk_cavities(WalkSurface surface, Vec3 v, WalkTargets targets,
                                            WalkRandom* random) {
    const real lost = walk_cavity_lost(surface, walk_cavity_is_dense(surface), v.z);
    WalkDeparture departure = walk_departure();
    if (walk_uniform(random) < lost) {
        const real u1 = walk_uniform(random), u2 = walk_uniform(random);
        departure.direction =
            walk_cavity_departure(surface, u1, u2, walk_uniform(random), &departure.passed);
    } else {
        departure = walk_one_facet(surface, v, random);
        departure.weight /= REAL(1.0) - lost;
    }
    walk_single_densities(surface, v, targets, &departure);
    if (targets.has_same)
        departure.same_density += walk_cavity_density(surface, v.z, 0, targets.same.z);
    if (targets.has_beyond)
        departure.beyond_density += walk_cavity_density(surface, v.z, 1, targets.beyond.z);
    return departure;
}

/// Density, 1/sr, with which the facet that the walk stands at reflects towards w and out. The
/// first one's height is averaged over: 1 / (1 + Lambda + Lambda) in all.
DEVICE_FUNCTION real walk_density_back(const WalkBetweenFacets* walk, Vec3 w) {
    const Vec3 h = walk_half_reflected(walk->v, w);
    const real density = walk_reflection_density(
        walk->surface, walk->v, h, walk_reflectance(walk->surface, vec3_dot(walk->v, h)));
    if (walk->order == 0u)
        return density * walk_single_share(walk->surface, walk->v, walk->v, w, REAL(1.0));
    return density * walk_escape(walk->surface, w, walk->height);
}

/// Returns the density, 1/sr, with which the facet that the walk stands at refracts towards w
/// (frame beyond the present medium) and out. The height is that of the walk, also at the first
/// facet.
DEVICE_FUNCTION real walk_density_through(const WalkBetweenFacets* walk, Vec3 w) {
    const WalkRefraction r = walk_refraction(walk->surface, walk->v, walk_mirrored(w));
    const real density = walk_refraction_density(
        walk->surface, walk->v, r, REAL(1.0) - walk_reflectance(walk->surface, r.cos_i));
    return density > REAL(0.0) ? density * walk_escape(walk->surface, w, REAL(1.0) - walk->height)
                               : REAL(0.0);
}

DEVICE_FUNCTION void walk_add_densities(const WalkBetweenFacets* walk, WalkTargets targets,
                                        WalkDeparture* departure) {
    const real weight = departure->weight;
    if (targets.has_same) {
        departure->same_density += weight * (walk->passed ? walk_density_through(walk, targets.same)
                                                          : walk_density_back(walk, targets.same));
    }
    if (targets.has_beyond) {
        departure->beyond_density +=
            weight * (walk->passed ? walk_density_back(walk, targets.beyond)
                                   : walk_density_through(walk, targets.beyond));
    }
}

/// Takes a walk from the facet of normal h to the next one, or out; returns 1 with *direction when
/// out.
DEVICE_FUNCTION int walk_to_next_facet(WalkBetweenFacets* walk, Vec3 h, int passes, real u,
                                       Vec3* direction) {
    real height;
    *direction = walk_leave_facet(walk->surface, walk->v, h, passes);
    if (passes)
        walk_pass_facet(walk);
    height = walk_next_height(walk->surface, *direction, walk->height, u);
    walk_meet_facet(walk, *direction, height);
    return height > REAL(1.0);
}

/// Facets that a walk meets before it is put under roulette: far beyond what light meets (each
/// leaves it a chance to get out), but it bounds the time.
#define WALK_FREE_FACETS 64u
#define WALK_LATE_SURVIVAL REAL(0.9)

/// Returns 1 to go on: late facets survive with a probability that the weight is divided by.
DEVICE_FUNCTION int walk_late_survives(uint order, WalkRandom* random, real* weight) {
    if (order < WALK_FREE_FACETS)
        return 1;
    *weight /= WALK_LATE_SURVIVAL;
    return walk_uniform(random) < WALK_LATE_SURVIVAL;
}

/// The whole walk between facets, which loses nothing.
DEVICE_FUNCTION WalkDeparture walk_smith(WalkSurface surface, Vec3 v, WalkTargets targets,
                                         WalkRandom* random) {
    WalkDeparture departure = walk_departure();
    WalkBetweenFacets walk = walk_between_facets(surface, v, walk_uniform(random));
    for (;;) {
        const real u1 = walk_uniform(random), u2 = walk_uniform(random);
        const Vec3 h =
            microfacet_sample(walk.surface.distribution, walk.surface.alpha, walk.v, u1, u2);
        const real cos_i = vec3_dot(walk.v, h);
        const int passes =
            !(walk_uniform(random) < walk_reflectance(walk.surface, fmax(cos_i, REAL(0.0))));
        walk_add_densities(&walk, targets, &departure);
        if (!(cos_i > REAL(0.0)) || !walk_late_survives(walk.order, random, &departure.weight)) {
            departure.weight = REAL(0.0);
            return departure;
        }
        if (walk_to_next_facet(&walk, h, passes, walk_uniform(random), &departure.direction)) {
            departure.passed = walk.passed;
            return departure;
        }
    }
}

/// A rough interface whose scattering is `multiple`.
DEVICE_FUNCTION WalkDeparture walk_multiple(WalkSurface surface, Vec3 v, WalkTargets targets,
                                            WalkRandom* random) {
    return surface.distribution == MICROFACET_BLINN ? walk_cavities(surface, v, targets, random)
                                                    : walk_smith(surface, v, targets, random);
}

/// Any interface between dielectrics.
DEVICE_FUNCTION WalkDeparture walk_interface(WalkSurface surface, Vec3 v, WalkTargets targets,
                                             WalkRandom* random) {
    if (!(surface.alpha > REAL(0.0)) || surface.eta == REAL(1.0))
        return walk_smooth(surface, v, random);
    return surface.multiple ? walk_multiple(surface, v, targets, random)
                            : walk_single(surface, v, targets, random);
}

KERNELS_END

#endif
