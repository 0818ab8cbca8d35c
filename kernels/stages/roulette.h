// Russian roulette.
#ifndef RERADIANT_ROULETTE_H
#define RERADIANT_ROULETTE_H

#include "kernels/core/portable.h"

/// Below this throughput a path is put under Russian roulette, and survives at least at the second.
#define ROULETTE_THROUGHPUT REAL(0.1)
#define ROULETTE_LEAST_SURVIVAL REAL(0.05)

/// Probability with which a path goes on from its vertex `depth` (0 is the first). `throughput`
/// bounds what the lane that carries most still brings: with the mean of the lanes in its place a
/// saturated colour's bright lanes would hang on few paths of large weight.
real path_survival(real throughput, uint depth, uint min_depth) {
    if (depth + 1u < min_depth)
        return REAL(1.0);
    return fmin(REAL(1.0),
                fmax(throughput * (REAL(1.0) / ROULETTE_THROUGHPUT), ROULETTE_LEAST_SURVIVAL));
}

#endif
