// Tables of functions of two directions above an isotropic surface: [cosine][other cosine][place],
// where a place stands for how the two lie to each other, as each table says for itself.
#ifndef RERADIANT_SHAPE_TABLE_H
#define RERADIANT_SHAPE_TABLE_H

#include "kernels/core/portable.h"
#include "kernels/core/shared.h"

KERNELS_BEGIN

/// Nodes of a table, symmetric in the cosines.
#define SHAPE_COSINES 16u
#define SHAPE_PLACES 17u
#define SHAPE_TABLE_SIZE (SHAPE_COSINES * SHAPE_COSINES * SHAPE_PLACES)

/// A place between two nodes.
typedef struct {
    uint node;
    real t;
} ShapePlace;

DEVICE_FUNCTION ShapePlace shape_place(real position, uint nodes) {
    const real inside = fmin(fmax(position, REAL(0.0)), (real)(nodes - 1u));
    ShapePlace place;
    place.node = (uint)inside;
    place.node = place.node > nodes - 2u ? nodes - 2u : place.node;
    place.t = inside - (real)place.node;
    return place;
}

/// Nodes of cosine are uniform in their square roots, from this one on.
#define SHAPE_LEAST REAL(0.1)

DEVICE_FUNCTION real shape_node_cosine(uint node, uint nodes) {
    return square(SHAPE_LEAST + (REAL(1.0) - SHAPE_LEAST) * ((real)node / (real)(nodes - 1u)));
}

/// Place of a cosine among so many nodes.
DEVICE_FUNCTION ShapePlace shape_cosine(real cosine, uint nodes) {
    const real x = sqrt(fmax(cosine, REAL(0.0)));
    return shape_place((x - SHAPE_LEAST) * ((real)(nodes - 1u) / (REAL(1.0) - SHAPE_LEAST)), nodes);
}

/// Returns a value of a table, linear between its nodes.
DEVICE_FUNCTION real shape_value(GLOBAL_CONST shared_float* table, ShapePlace i, ShapePlace o,
                                 ShapePlace s) {
    real sum = REAL(0.0);
    for (uint corner = 0u; corner < 4u; ++corner) {
        const uint down = corner & 1u, right = corner >> 1u;
        GLOBAL_CONST shared_float* row =
            table + ((i.node + down) * SHAPE_COSINES + o.node + right) * SHAPE_PLACES + s.node;
        sum += (down ? i.t : REAL(1.0) - i.t) * (right ? o.t : REAL(1.0) - o.t) *
               (row[0] + s.t * (row[1] - row[0]));
    }
    return sum;
}

KERNELS_END

#endif
