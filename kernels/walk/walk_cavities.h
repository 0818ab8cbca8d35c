// Blinn's V-cavities, as a random walk meets them: facets sampled as they are seen, and what they
// lose to single scattering given back where scattering is `multiple`, into both media in
// proportion to n^2 c lost(c) (host/layers/rough/lost_flux.h makes the table).
//
// The table of a surface: cells of its thinner and of its denser side, the sum of etendue times
// lost share; then for either side the edges of its cells in cosine and the lost share of each;
// then the running sum over all cells. A mirror has a thinner side only.
#ifndef RERADIANT_WALK_CAVITIES_H
#define RERADIANT_WALK_CAVITIES_H

#include "kernels/core/portable.h"
#include "kernels/core/sampling.h"
#include "kernels/core/shared.h"
#include "kernels/core/table.h"
#include "kernels/walk/walk_facets.h"

KERNELS_BEGIN

#define WALK_CAVITIES_HEADER 3u

/// Cells of one side.
typedef struct {
    WalkTable edges;
    WalkTable lost;
    uint count;
} WalkCavitySide;

DEVICE_FUNCTION WalkCavitySide walk_cavity_side(WalkTable table, int dense) {
    const uint thin_cells = (uint)table[0];
    WalkCavitySide side;
    side.count = (uint)table[dense ? 1 : 0];
    side.edges = table + WALK_CAVITIES_HEADER + (dense ? 2u * thin_cells + 1u : 0u);
    side.lost = side.edges + side.count + 1u;
    return side;
}

/// Index of the last of `count` ascending numbers that is not above x; 0 when all are.
DEVICE_FUNCTION uint walk_last_below(WalkTable numbers, uint count, real x) {
    return table_search(numbers + 1, count - 1u, 1u, x);
}

/// Share of the light from a cosine that single scattering loses.
DEVICE_FUNCTION real walk_cavity_lost(WalkSurface surface, int dense, real cosine) {
    const WalkCavitySide side = walk_cavity_side(surface.cavities, dense);
    return side.lost[walk_last_below(side.edges, side.count, cosine)];
}

/// The side that `surface` is seen from.
DEVICE_FUNCTION int walk_cavity_is_dense(WalkSurface surface) {
    return !surface.is_mirror && surface.eta < REAL(1.0);
}

/// n^2 of a side, that of the thinner one being 1.
DEVICE_FUNCTION real walk_cavity_ior2(WalkSurface surface, int dense) {
    return dense ? fmax(square(surface.eta), REAL(1.0) / square(surface.eta)) : REAL(1.0);
}

/// Density, 1/sr with the cosine of where it goes, of what is given back of light from cos_v.
DEVICE_FUNCTION real walk_cavity_density(WalkSurface surface, real cos_v, int passed, real cos_w) {
    const int dense = walk_cavity_is_dense(surface);
    const real total = surface.cavities[2];
    const int beyond = passed ? !dense : dense;
    return total > REAL(0.0) ? walk_cavity_lost(surface, dense, cos_v) *
                                   walk_cavity_lost(surface, beyond, cos_w) *
                                   walk_cavity_ior2(surface, beyond) * cos_w * INV_PI_REAL / total
                             : REAL(0.0);
}

/// Samples the direction in which light that is given back leaves, with a probability in proportion
/// to n^2 c lost(c), where c is its cosine. Sets *passed to whether it leaves beyond the surface,
/// and returns the direction in the frame of its side.
DEVICE_FUNCTION Vec3 walk_cavity_departure(WalkSurface surface, real u1, real u2, real u3,
                                           int* passed) {
    const uint thin = (uint)surface.cavities[0], dense = (uint)surface.cavities[1];
    const WalkTable cumulative =
        surface.cavities + WALK_CAVITIES_HEADER + 2u * (thin + dense) + (dense > 0u ? 2u : 1u);
    const uint count = thin + dense;
    const real target = u1 * surface.cavities[2];
    // the first sum above the target
    uint cell = (real)cumulative[0] > target ? 0u : walk_last_below(cumulative, count, target) + 1u;
    cell = cell < count ? cell : count - 1u;
    {
        const int to_dense = cell >= thin;
        const WalkCavitySide side = walk_cavity_side(surface.cavities, to_dense);
        const uint k = to_dense ? cell - thin : cell;
        const real low = side.edges[k], high = side.edges[k + 1u];
        const real c2 = fmin(low * low + (high - low) * (high + low) * u2, REAL(1.0));
        const real s = sqrt(REAL(1.0) - c2);
        const Vec3 around = sampling_circle(u3);
        *passed = to_dense != walk_cavity_is_dense(surface);
        return vec3(s * around.x, s * around.y, sqrt(c2));
    }
}

KERNELS_END

#endif
