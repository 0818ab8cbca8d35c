// Where light goes that passes a sheet with rough faces, as a table: the ratio to the lobe of
// facets over the half vector of one direction and the mirror image of the other.
// host/layers/models/through_lobe.h makes it.
#ifndef RERADIANT_THROUGH_SHAPE_H
#define RERADIANT_THROUGH_SHAPE_H

#include "kernels/scatter/shape_table.h"

KERNELS_BEGIN

/// Nodes of the table [cosine][slope][azimuth]: of the direction on one side of the sheet, and of
/// the half vector, whose azimuth is taken from that of the direction, 0 to pi.
#define THROUGH_COSINES 32u
#define THROUGH_SLOPES 28u
#define THROUGH_AZIMUTHS 9u
#define THROUGH_TABLE_SIZE (THROUGH_COSINES * THROUGH_SLOPES * THROUGH_AZIMUTHS)

/// Cosines are uniform in their square roots, from this one on.
#define THROUGH_LEAST REAL(0.1)

DEVICE_FUNCTION real through_shape_node_cosine(uint node) {
    return square(THROUGH_LEAST +
                  (REAL(1.0) - THROUGH_LEAST) * ((real)node / (real)(THROUGH_COSINES - 1u)));
}

DEVICE_FUNCTION ShapePlace through_shape_cosine(real cosine) {
    const real x = sqrt(fmax(cosine, REAL(0.0)));
    return shape_place((x - THROUGH_LEAST) *
                           ((real)(THROUGH_COSINES - 1u) / (REAL(1.0) - THROUGH_LEAST)),
                       THROUGH_COSINES);
}

/// Largest slope of a half vector whose other direction lies above the horizon.
DEVICE_FUNCTION real through_shape_largest(real cosine) {
    // tan((theta + pi / 2) / 2) = (1 + sin) / cos
    return (REAL(1.0) + sqrt(fmax(REAL(1.0) - square(cosine), REAL(0.0)))) /
           fmax(cosine, square(THROUGH_LEAST));
}

/// Position among the nodes of slope, from 0 to 1, for a lobe of a width: they lie closer where the
/// lobe is, and go as the logarithm of the slope beyond.
DEVICE_FUNCTION real through_shape_position(real width, real cosine, real slope) {
    return log(REAL(1.0) + slope / width) / log(REAL(1.0) + through_shape_largest(cosine) / width);
}

/// Returns the ratio, unit 1, for a direction on the table's side of the sheet and one on the other
/// side, of which one is given by its mirror image; `width`: that of the lobe from the first
/// direction straight on.
DEVICE_FUNCTION real through_shape_value(GLOBAL_CONST shared_float* table, real width, Vec3 own,
                                         Vec3 other) {
    const Vec3 sum = vec3_add(own, other);
    const real across = sqrt(sum.x * sum.x + sum.y * sum.y);
    const real slope = across / fmax(sum.z, REAL(1e-15));
    const real along = own.x * sum.x + own.y * sum.y, beside = own.x * sum.y - own.y * sum.x;
    const ShapePlace c = through_shape_cosine(own.z);
    const ShapePlace s = shape_place(
        through_shape_position(width, own.z, slope) * (real)(THROUGH_SLOPES - 1u), THROUGH_SLOPES);
    const ShapePlace a = shape_place(
        fabs(atan2(beside, along)) * INV_PI_REAL * (real)(THROUGH_AZIMUTHS - 1u), THROUGH_AZIMUTHS);
    real value = REAL(0.0);
    for (uint corner = 0u; corner < 4u; ++corner) {
        const uint next_c = corner & 1u, next_s = corner >> 1u;
        GLOBAL_CONST shared_float* row =
            table + ((c.node + next_c) * THROUGH_SLOPES + s.node + next_s) * THROUGH_AZIMUTHS +
            a.node;
        value += (next_c ? c.t : REAL(1.0) - c.t) * (next_s ? s.t : REAL(1.0) - s.t) *
                 (row[0] + a.t * (row[1] - row[0]));
    }
    return value;
}

KERNELS_END

#endif
