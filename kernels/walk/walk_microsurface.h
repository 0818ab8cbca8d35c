// The walk between the facets of a Smith microsurface, step by step (Heitz, Hanika, d'Eon and
// Dachsbacher 2016, sections 4 to 6): heights, and the state that goes from facet to facet.
#ifndef RERADIANT_WALK_MICROSURFACE_H
#define RERADIANT_WALK_MICROSURFACE_H

#include "kernels/core/portable.h"
#include "kernels/walk/walk_facets.h"

KERNELS_BEGIN

/// Heights are counted by the share C of the surface below them, as seen from the medium that the
/// walk is in: 1 at the top, 1 - C from the other side. Only C matters, whatever its distribution.
DEVICE_FUNCTION real walk_bounded_height(real height) {
    return fmin(fmax(height, WALK_LEAST_HEIGHT), WALK_MOST_HEIGHT);
}

/// Probability that a ray from a height leaves the surface along w: C^Lambda, 0 downwards.
DEVICE_FUNCTION real walk_escape(WalkSurface surface, Vec3 w, real height) {
    return w.z > REAL(0.0) ? exp(walk_lambda(surface, w) * log(height)) : REAL(0.0);
}

/// Height of the next facet on a ray upwards that does not leave, from the ray's Lambda and the
/// logarithm of a number that is uniform between the probability of escape and 1 (eq. 19).
DEVICE_FUNCTION real walk_height_above(real height, real lambda, real log_u) {
    return walk_bounded_height(height * exp(-log_u / lambda));
}

/// Height of the next facet on a ray along w, w.z <= 0, which always meets one. u uniform in [0,
/// 1).
DEVICE_FUNCTION real walk_height_below(WalkSurface surface, Vec3 w, real height, real u) {
    return walk_bounded_height(
        height * exp(log1p(-u) / (REAL(1.0) + walk_lambda(surface, vec3_scale(w, REAL(-1.0))))));
}

/// Height of the next facet on a ray along w; above 1 when the ray leaves the surface. u uniform in
/// [0, 1).
DEVICE_FUNCTION real walk_next_height(WalkSurface surface, Vec3 w, real height, real u) {
    if (!(w.z > REAL(0.0)))
        return walk_height_below(surface, w, height, u);
    return u < walk_escape(surface, w, height)
               ? REAL(2.0)
               : walk_height_above(height, walk_lambda(surface, w), log(u));
}

/// Returns the next height of a ray that is known not to leave. Where nearly all leave, the limit
/// is taken.
DEVICE_FUNCTION real walk_met_height(WalkSurface surface, Vec3 w, real height, real u) {
    real lambda, stays;
    if (!(w.z > REAL(0.0)))
        return walk_height_below(surface, w, height, u);
    lambda = fmax(walk_lambda(surface, w), WALK_LEAST_LAMBDA);
    stays = -expm1(lambda * log(height));
    return walk_height_above(height, lambda, log1p(-u * stays));
}

/// A walk between facets. `surface` is seen from the medium that the walk is in.
typedef struct {
    WalkSurface surface;
    Vec3 v;
    real height;
    int passed; ///< in the medium beyond the one of arrival
    uint order; ///< facets met so far
} WalkBetweenFacets;

/// Light that comes from v, at the first facet that it meets (u uniform in [0, 1)).
DEVICE_FUNCTION WalkBetweenFacets walk_between_facets(WalkSurface surface, Vec3 v, real u) {
    WalkBetweenFacets walk;
    walk.surface = surface;
    walk.v = v;
    walk.height = walk_height_below(surface, vec3_scale(v, REAL(-1.0)), REAL(1.0), u);
    walk.passed = 0;
    walk.order = 0u;
    return walk;
}

/// Takes the walk through the facet that it stands at, into the medium beyond.
DEVICE_FUNCTION void walk_pass_facet(WalkBetweenFacets* walk) {
    walk->surface = walk_from_beyond(walk->surface);
    walk->height = walk_bounded_height(REAL(1.0) - walk->height);
    walk->passed = !walk->passed;
}

/// Takes the walk along w to the facet at a height.
DEVICE_FUNCTION void walk_meet_facet(WalkBetweenFacets* walk, Vec3 w, real height) {
    walk->height = height;
    walk->v = vec3_scale(w, REAL(-1.0));
    ++walk->order;
}

KERNELS_END

#endif
