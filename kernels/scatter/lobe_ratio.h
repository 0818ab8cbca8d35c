// Where light goes that several surfaces have spread, as a table: the ratio to a lobe of facets
// over the half vector of both directions. Of light that passes a sheet one of them is a mirror
// image. host/layers/models/lobe_ratios.h makes it.
#ifndef RERADIANT_LOBE_RATIO_H
#define RERADIANT_LOBE_RATIO_H

#include "kernels/scatter/shape_table.h"

KERNELS_BEGIN

/// Nodes of the table [cosine][slope][azimuth]: of the first direction, and of the half vector,
/// whose azimuth is taken from that of the direction, 0 to pi.
#define LOBE_RATIO_COSINES 32u
#define LOBE_RATIO_SLOPES 28u
#define LOBE_RATIO_AZIMUTHS 9u
#define LOBE_RATIO_SIZE (LOBE_RATIO_COSINES * LOBE_RATIO_SLOPES * LOBE_RATIO_AZIMUTHS)

/// Cosines are uniform in their square roots, from this one on.
#define LOBE_RATIO_LEAST REAL(0.1)

DEVICE_FUNCTION real lobe_ratio_node_cosine(uint node) {
    return square(LOBE_RATIO_LEAST +
                  (REAL(1.0) - LOBE_RATIO_LEAST) * ((real)node / (real)(LOBE_RATIO_COSINES - 1u)));
}

DEVICE_FUNCTION ShapePlace lobe_ratio_cosine(real cosine) {
    const real x = sqrt(fmax(cosine, REAL(0.0)));
    return shape_place((x - LOBE_RATIO_LEAST) *
                           ((real)(LOBE_RATIO_COSINES - 1u) / (REAL(1.0) - LOBE_RATIO_LEAST)),
                       LOBE_RATIO_COSINES);
}

/// Largest slope of a half vector whose other direction lies above the horizon.
DEVICE_FUNCTION real lobe_ratio_largest(real cosine) {
    // tan((theta + pi / 2) / 2) = (1 + sin) / cos
    return (REAL(1.0) + sqrt(fmax(REAL(1.0) - square(cosine), REAL(0.0)))) /
           fmax(cosine, square(LOBE_RATIO_LEAST));
}

/// Position among the nodes of slope, from 0 to 1, for a lobe of a width: they lie closer where the
/// lobe is, and go as the logarithm of the slope beyond.
DEVICE_FUNCTION real lobe_ratio_position(real width, real cosine, real slope) {
    return log(REAL(1.0) + slope / width) / log(REAL(1.0) + lobe_ratio_largest(cosine) / width);
}

/// Returns the ratio, unit 1; `width`: that of the lobe from the first direction, `own`, to its
/// mirror direction.
DEVICE_FUNCTION real lobe_ratio_value(GLOBAL_CONST shared_float* table, real width, Vec3 own,
                                      Vec3 other) {
    const Vec3 sum = vec3_add(own, other);
    const real across = sqrt(sum.x * sum.x + sum.y * sum.y);
    const real slope = across / fmax(sum.z, REAL(1e-15));
    const real along = own.x * sum.x + own.y * sum.y, beside = own.x * sum.y - own.y * sum.x;
    const ShapePlace c = lobe_ratio_cosine(own.z);
    const ShapePlace s =
        shape_place(lobe_ratio_position(width, own.z, slope) * (real)(LOBE_RATIO_SLOPES - 1u),
                    LOBE_RATIO_SLOPES);
    const ShapePlace a =
        shape_place(fabs(atan2(beside, along)) * INV_PI_REAL * (real)(LOBE_RATIO_AZIMUTHS - 1u),
                    LOBE_RATIO_AZIMUTHS);
    real value = REAL(0.0);
    for (uint corner = 0u; corner < 4u; ++corner) {
        const uint next_c = corner & 1u, next_s = corner >> 1u;
        GLOBAL_CONST shared_float* row =
            table +
            ((c.node + next_c) * LOBE_RATIO_SLOPES + s.node + next_s) * LOBE_RATIO_AZIMUTHS +
            a.node;
        value += (next_c ? c.t : REAL(1.0) - c.t) * (next_s ? s.t : REAL(1.0) - s.t) *
                 (row[0] + a.t * (row[1] - row[0]));
    }
    return value;
}

KERNELS_END

#endif
