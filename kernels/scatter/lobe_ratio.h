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

DEVICE_FUNCTION real lobe_ratio_node_cosine(uint node) {
    return shape_node_cosine(node, LOBE_RATIO_COSINES);
}

/// Largest slope of a half vector whose other direction lies above the horizon.
DEVICE_FUNCTION real lobe_ratio_largest(real cosine) {
    // tan((theta + pi / 2) / 2) = (1 + sin) / cos
    return (REAL(1.0) + sqrt(fmax(REAL(1.0) - square(cosine), REAL(0.0)))) /
           fmax(cosine, square(SHAPE_LEAST));
}

/// Slope of the half vector that is half way among the nodes where the largest one is far, over the
/// width of the lobe at normal incidence.
#define LOBE_RATIO_MIDDLE REAL(8.0)

/// Place of half the nodes among slopes over the largest, unit 1.
DEVICE_FUNCTION real lobe_ratio_middle(real width, real cosine) {
    return LOBE_RATIO_MIDDLE * width / lobe_ratio_largest(cosine);
}

/// Angle whose cosine is given, over pi, to 3e-5 (Abramowitz and Stegun 1964, 4.4.45).
DEVICE_FUNCTION real lobe_ratio_azimuth(real cosine) {
    const real x = fmin(fabs(cosine), REAL(1.0));
    const real angle =
        sqrt(REAL(1.0) - x) *
        (REAL(1.5707288) + x * (REAL(-0.2121144) + x * (REAL(0.0742610) - x * REAL(0.0187293))));
    return INV_PI_REAL * (cosine < REAL(0.0) ? PI_REAL - angle : angle);
}

/// Returns the ratio, unit 1; `width`: that of the lobe at normal incidence.
DEVICE_FUNCTION real lobe_ratio_value(GLOBAL_CONST shared_float* table, real width, Vec3 own,
                                      Vec3 other) {
    const Vec3 sum = vec3_add(own, other);
    const real across2 = sum.x * sum.x + sum.y * sum.y, own2 = own.x * own.x + own.y * own.y;
    const real slope = sqrt(across2) / fmax(sum.z, REAL(1e-15));
    const real along = own.x * sum.x + own.y * sum.y;
    const real u = fmin(slope / lobe_ratio_largest(own.z), REAL(1.0));
    const real k = lobe_ratio_middle(width, own.z);
    const ShapePlace c = shape_cosine(own.z, LOBE_RATIO_COSINES);
    const ShapePlace s = shape_place(u * (REAL(1.0) + k) / (u + k) * (real)(LOBE_RATIO_SLOPES - 1u),
                                     LOBE_RATIO_SLOPES);
    const ShapePlace a =
        shape_place(lobe_ratio_azimuth(along / sqrt(fmax(across2 * own2, REAL(1e-30)))) *
                        (real)(LOBE_RATIO_AZIMUTHS - 1u),
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
