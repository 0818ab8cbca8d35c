// Tables over the cosine of an angle, in u = sqrt(cos): transmissions behave as cos near grazing,
// a parabola in u, which cubic interpolation reproduces exactly. And the search in ascending
// tables.
#ifndef RERADIANT_TABLE_H
#define RERADIANT_TABLE_H

#include "kernels/core/portable.h"
#include "kernels/core/shared.h"

KERNELS_BEGIN

/// Four neighbouring nodes and their Lagrange weights. The stencil shifts at both ends, so it is
/// exact for cubics everywhere. Error for smooth tables: about 3e-9 of the fourth derivative.
typedef struct {
    uint node;
    real w0, w1, w2, w3;
} TableStencil;

DEVICE_FUNCTION TableStencil table_stencil(real cosine) {
    const real position = sqrt(fmin(fmax(cosine, REAL(0.0)), REAL(1.0))) * (real)(TABLE_NODES - 1);
    int first = (int)position - 1;
    first = first < 0 ? 0 : first;
    first = first > TABLE_NODES - 4 ? TABLE_NODES - 4 : first;
    const real t = position - (real)first;
    TableStencil s;
    s.node = (uint)first;
    s.w0 = (t - REAL(1.0)) * (t - REAL(2.0)) * (t - REAL(3.0)) * REAL(-0.16666666666666667);
    s.w1 = t * (t - REAL(2.0)) * (t - REAL(3.0)) * REAL(0.5);
    s.w2 = t * (t - REAL(1.0)) * (t - REAL(3.0)) * REAL(-0.5);
    s.w3 = t * (t - REAL(1.0)) * (t - REAL(2.0)) * REAL(0.16666666666666667);
    return s;
}

/// Counts those of `count` ascending numbers, `stride` floats apart, that are not above x: the
/// index of the first that is. With a table of cumulative probabilities, less its last, and x
/// uniform in [0, 1), that is the choice.
#ifdef __OPENCL_VERSION__
typedef __global const shared_float* TableNumbers;
#else
template <typename TableNumbers> // floats as the device has them, or the doubles of the host's walk
#endif
DEVICE_FUNCTION uint table_search(TableNumbers numbers, uint count, uint stride, real x) {
    uint low = 0u, high = count;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if ((real)numbers[middle * stride] <= x)
            low = middle + 1u;
        else
            high = middle;
    }
    return low;
}

KERNELS_END

#endif
