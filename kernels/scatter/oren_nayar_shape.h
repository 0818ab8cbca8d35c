// An Oren-Nayar substrate as it is seen through a stack, by tables that
// host/layers/models/oren_nayar_substrate.h describes: the albedo of the separable form in which
// light that comes back to it is followed, and its shape where rough interfaces or slabs spread the
// light on its way, so that it arrives from around the refracted direction.
#ifndef RERADIANT_OREN_NAYAR_SHAPE_H
#define RERADIANT_OREN_NAYAR_SHAPE_H

#include "kernels/scatter/shape_table.h"

KERNELS_BEGIN

/// Cosine at a node; nodes are uniform in sqrt(1 - cosine), which goes as the sine near the normal.
/// The last one stands for grazing light.
DEVICE_FUNCTION real oren_nayar_node_cosine(uint node) {
    return fmax(REAL(1.0) - square((real)node / (real)(SHAPE_COSINES - 1u)), REAL(0.003));
}
DEVICE_FUNCTION ShapePlace oren_nayar_place(real cosine) {
    return shape_place(sqrt(fmax(REAL(1.0) - cosine, REAL(0.0))) * (real)(SHAPE_COSINES - 1u),
                       SHAPE_COSINES);
}

/// Albedo of the separable form, unit 1, by cosine in air: SHAPE_COSINES nodes.
DEVICE_FUNCTION real oren_nayar_separable_albedo(GLOBAL_CONST shared_float* table, real cosine) {
    const ShapePlace place = oren_nayar_place(cosine);
    return table[place.node] + place.t * (table[place.node + 1u] - table[place.node]);
}

/// pi f / rho, unit 1, by directions in air above the surface: a shape table whose places are
/// uniform in the cosine of the azimuth between the two, from -1 on. Symmetric in them.
DEVICE_FUNCTION real oren_nayar_spread_value(GLOBAL_CONST shared_float* table, Vec3 wi, Vec3 wo) {
    const real sin_i = sqrt(wi.x * wi.x + wi.y * wi.y), sin_o = sqrt(wo.x * wo.x + wo.y * wo.y);
    const real azimuth = (wi.x * wo.x + wi.y * wo.y) / fmax(sin_i * sin_o, REAL(1e-30));
    const ShapePlace place =
        shape_place((azimuth + REAL(1.0)) * (REAL(0.5) * (real)(SHAPE_PLACES - 1u)), SHAPE_PLACES);
    return shape_value(table, oren_nayar_place(wi.z), oren_nayar_place(wo.z), place);
}

KERNELS_END

#endif
