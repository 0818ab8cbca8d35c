// How a walk's connections to a sampled light and the walk's own direction, where that meets the
// same light by chance, share the light's radiance (multiple importance sampling, Veach 1997).
//
// Both find the same paths through the stack: a connection does by an event of the camera's half
// that is evaluated towards the light's half, chance by the same event when it happens to leave
// that way and then comes up to the air by smooth surfaces and upward transmissions alone
// (walk_light.h). What differs is one density: chance has that of the event towards w, per solid
// angle in the medium there; a connection has that of the light's direction, per solid angle in
// air. Transmissions are reciprocal, so that those on the way between the two change a bundle of
// directions by n^2 cos in the medium over cos in air, on the way up as on the way down. The
// event's density times cos_air / (n^2 cos) is therefore chance's, per solid angle in air.
//
// The two weights add up to one for each path whatever stands for the density, as long as it is a
// function of the directions alone: so it leaves out Fresnel shares on the way up and light that
// is scattered between facets more than once.
#ifndef RERADIANT_WALK_CHANCE_H
#define RERADIANT_WALK_CHANCE_H

#include "kernels/core/portable.h"
#include "kernels/walk/walk_interface.h"

KERNELS_BEGIN

/// Density with which a rough surface, met from v, leaves towards w (in the frame of its side),
/// 1/sr with the cosine of w.
DEVICE_FUNCTION real walk_chance_at_facets(WalkSurface surface, Vec3 v, Vec3 w, int passed) {
    const real facets = walk_single_density(surface, v, w, passed);
    return surface.multiple && surface.distribution == MICROFACET_BLINN
               ? facets + walk_cavity_density(surface, v.z, passed, w.z)
               : facets;
}

/// A density towards a direction of cosine cos_w in a medium, without its factor cos_air on the
/// way to the air.
DEVICE_FUNCTION real walk_chance_below(real density, real ior, real cos_w) {
    return density / (square(ior) * fmax(cos_w, REAL(1e-6)));
}

KERNELS_END

#endif
