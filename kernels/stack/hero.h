// Wavelength sampling `hero`: a path carries HERO wavelengths rotated from one (Wilkie et al.,
// "Hero Wavelength Spectral Sampling", EGSR 2014), and where the substrate re-radiates the shift
// is sampled from its matrix, emission given, excitation sought (after Mojzik et al., "Handling
// Fluorescence in a Uni-directional Spectral Path Tracer", EGSR 2018).
//
// A vertex maps the radiance that comes in at wavelengths i to that which leaves at o,
//     L(o) = sum over i of A(o, i) L_in(i),   A = T B T + specular on the diagonal,
// a sum over the plan's lanes. The set o_1 .. o_N with which the path arrives from the camera is
// known. Each o_m draws one i_m from its own row of probabilities p(i | o_m), positive wherever
// A(o_m, i) is and at least LEAST_UNSHIFTED at i = o_m. All N of them serve all N: every o_m is a
// technique to find an excitation, combined by the balance heuristic (Veach and Guibas 1995),
//     L(o_j) ~ sum over k of A(o_j, i_k) L_in(i_k) w_k,   w_k = 1 / sum over m of p(i_k | o_m).
// A lane sampled twice counts twice, with half the weight; lines are lanes like all others, their
// power is in p. At a vertex that does not re-radiate i_k = o_k and w_k = 1. The first set is
// rotated over all lanes that the film sees, each in it with the same probability, so that a
// lane's radiance counts (lanes / N) times. Nothing depends on a direction's pdf: directions are
// chosen without regard to wavelength (shade.cl), and all N see the same ones.
#ifndef RERADIANT_HERO_H
#define RERADIANT_HERO_H

#include "kernels/core/features.h"
#include "kernels/core/table.h"

#if HERO > 8
typedef float16 Lanes;
typedef uint16 HeroLanes;
#define HERO_WIDTH 16
#define HERO_LOAD vload16
#define HERO_STORE vstore16
#elif HERO > 4
typedef float8 Lanes;
typedef uint8 HeroLanes;
#define HERO_WIDTH 8
#define HERO_LOAD vload8
#define HERO_STORE vstore8
#else
typedef float4 Lanes;
typedef uint4 HeroLanes;
#define HERO_WIDTH 4
#define HERO_LOAD vload4
#define HERO_STORE vstore4
#endif

/// Random dimensions of wavelengths, far from those of lights, directions and textures.
#define HERO_DIMENSION 0x20000000u

/// Places of a vector beyond HERO repeat the first wavelength and are never read.
uint hero_lane(HeroLanes lanes, uint place) {
    return ((const uint*)&lanes)[place];
}

/// Values of a row [lane] at the set's lanes.
Lanes hero_row(HeroLanes lanes, __global const float* row) {
    Lanes values;
    for (uint j = 0u; j < HERO_WIDTH; ++j)
        ((float*)&values)[j] = row[hero_lane(lanes, j)];
    return values;
}

/// `value` where the set's lane is `lane`, else 0.
Lanes hero_where_equal(HeroLanes lanes, uint lane, Lanes value) {
    return select((Lanes)(0.0f), value, lanes == (HeroLanes)(lane));
}

/// `value` where the set's lane lies above `lane`, else 0.
Lanes hero_where_above(HeroLanes lanes, uint lane, Lanes value) {
    return select((Lanes)(0.0f), value, lanes > (HeroLanes)(lane));
}

/// HERO lanes of `count`, as evenly apart as they can be, from a hero chosen by u in [0, 1).
HeroLanes hero_rotated(float u, uint first, uint count) {
    const uint hero = min((uint)(u * (float)count), count - 1u);
    HeroLanes lanes = (HeroLanes)(first + hero);
    for (uint j = 1u; j < HERO; ++j)
        ((uint*)&lanes)[j] = first + (hero + j * count / HERO) % count;
    return lanes;
}

/// First lane whose cumulative probability lies above u.
uint hero_search(__global const float* cumulative, float u) {
    return table_search(cumulative, LANES - 1u, 1u, u);
}

float hero_probability(__global const float* cumulative, uint lane) {
    return cumulative[lane] - (lane > 0u ? cumulative[lane - 1u] : 0.0f);
}

/// An excitation for every emission lane, by one number u rotated over the set; *weights: w_k.
/// rows: cumulative probabilities [emission lane][excitation lane] of one phase.
HeroLanes hero_shift(__global const float* rows, HeroLanes from, float u, Lanes* weights) {
    HeroLanes to = from;
    for (uint j = 0u; j < HERO; ++j) {
        const float turned = u + (float)j / HERO;
        ((uint*)&to)[j] = hero_search(rows + (size_t)hero_lane(from, j) * LANES,
                                      turned < 1.0f ? turned : turned - 1.0f);
    }
    for (uint k = 0u; k < HERO; ++k) {
        float sum = 0.0f;
        for (uint m = 0u; m < HERO; ++m)
            sum += hero_probability(rows + (size_t)hero_lane(from, m) * LANES, hero_lane(to, k));
        ((float*)weights)[k] = 1.0f / sum;
    }
    return to;
}

/// Returns at the lanes `to` what leaves of `value`, given at the lanes `from`, where the
/// wavelength stays.
Lanes hero_unshifted(HeroLanes to, HeroLanes from, Lanes value) {
    Lanes sum = (Lanes)(0.0f);
    for (uint k = 0u; k < HERO; ++k)
        sum += hero_where_equal(to, hero_lane(from, k), (Lanes)(((const float*)&value)[k]));
    return sum;
}

/// Does what reradiation_factored (reradiation.h) does, from the lanes of one set to those of
/// another.
Lanes hero_factored(HeroLanes to, HeroLanes from, Lanes in, __global const float* factors,
                    uint rank) {
    Lanes sum = (Lanes)(0.0f);
    for (uint r = 0u; r < rank; ++r) {
        const Lanes emission = hero_row(to, factors + r * LANES);
        const Lanes excited = in * hero_row(from, factors + (rank + r) * LANES);
        for (uint k = 0u; k < HERO; ++k)
            sum += hero_where_above(to, hero_lane(from, k), emission * ((const float*)&excited)[k]);
    }
    return sum;
}

/// Applies a dense matrix by columns, matrix[excitation * LANES + emission], from the lanes of one
/// set to those of another.
Lanes hero_dense(HeroLanes to, HeroLanes from, Lanes in, __global const float* matrix) {
    Lanes sum = (Lanes)(0.0f);
    for (uint k = 0u; k < HERO; ++k)
        sum += hero_row(to, matrix + (size_t)hero_lane(from, k) * LANES) * ((const float*)&in)[k];
    return sum;
}

#endif
