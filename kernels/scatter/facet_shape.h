// Where a rough surface sends the light that its facets scatter more than once, as a table. Such
// light has a peak of its own, beside that of the light that met one facet: the table holds the
// ratio to the lobe D G2 / (4 cos_i cos_o) of ggx facets as rough as the surface, which varies
// little. host/layers/rough/facet_shape.h makes it.
#ifndef RERADIANT_FACET_SHAPE_H
#define RERADIANT_FACET_SHAPE_H

#include "kernels/scatter/shape_table.h"

KERNELS_BEGIN

DEVICE_FUNCTION real facet_shape_node_cosine(uint node) {
    return shape_node_cosine(node, SHAPE_COSINES);
}

/// Place of the half vector of two directions among those that their cosines allow: 0 where their
/// azimuths are opposite, 1 where they are the same. With q = (1 + cos phi) / 2 the square of its
/// slope over alpha goes as 1 + rho q; the place is q (1 + k) / (q + k), k = 1 / sqrt(1 + rho),
/// which is half way where that is half way in its logarithm.
DEVICE_FUNCTION real facet_shape_slope(real alpha, Vec3 wi, Vec3 wo) {
    const real sin_i = sqrt(wi.x * wi.x + wi.y * wi.y), sin_o = sqrt(wo.x * wo.x + wo.y * wo.y);
    // sums of unit vectors and differences of cosines, where 1 + cos phi and the sines would cancel
    const real unit_i = REAL(1.0) / fmax(sin_i, REAL(1e-15));
    const real unit_o = REAL(1.0) / fmax(sin_o, REAL(1e-15));
    const real x = unit_i * wi.x + unit_o * wo.x, y = unit_i * wi.y + unit_o * wo.y;
    const real q = REAL(0.25) * (x * x + y * y);
    const real sum = square(alpha * fmax(wi.z + wo.z, REAL(1e-15)));
    const real across = square(fmax(sin_i + sin_o, REAL(1e-15)));
    const real difference = sum * square(wi.z - wo.z) / (square(alpha) * across);
    // 1 / (1 + rho) = (sum + difference) / (sum + difference + 4 sin_i sin_o)
    const real k = sqrt((sum + difference) / (sum + difference + REAL(4.0) * sin_i * sin_o));
    return q * (REAL(1.0) + k) / (q + k);
}

/// Ratio to the ggx lobe of width `alpha`, unit 1, linear between the table's nodes. Both
/// directions above the surface; symmetric in them.
DEVICE_FUNCTION real facet_shape_value(GLOBAL_CONST shared_float* table, real alpha, Vec3 wi,
                                       Vec3 wo) {
    const ShapePlace s =
        shape_place(facet_shape_slope(alpha, wi, wo) * (real)(SHAPE_PLACES - 1u), SHAPE_PLACES);
    return shape_value(table, shape_cosine(wi.z, SHAPE_COSINES), shape_cosine(wo.z, SHAPE_COSINES),
                       s);
}

KERNELS_END

#endif
