// Re-radiation of one vector of lanes: diagonal plus strictly lower triangle (emission above
// excitation), in masked factored form as a running sum, or dense.
#ifndef RERADIANT_RERADIATION_H
#define RERADIANT_RERADIATION_H

#include "kernels/core/features.h"

/// Exclusive running sum over the 16 lanes of a vector, and its total. Four shifted additions
/// (Hillis and Steele 1986).
float16 reradiation_exclusive_sum(float16 v, float* total) {
    float16 s = v;
    s += (float16)(0.0f, s.s0, s.s1, s.s2, s.s3, s.s4, s.s5, s.s6, s.s7, s.s8, s.s9, s.sa, s.sb,
                   s.sc, s.sd, s.se);
    s += (float16)(0.0f, 0.0f, s.s0, s.s1, s.s2, s.s3, s.s4, s.s5, s.s6, s.s7, s.s8, s.s9, s.sa,
                   s.sb, s.sc, s.sd);
    s += (float16)(0.0f, 0.0f, 0.0f, 0.0f, s.s0, s.s1, s.s2, s.s3, s.s4, s.s5, s.s6, s.s7, s.s8,
                   s.s9, s.sa, s.sb);
    s += (float16)(0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, s.s0, s.s1, s.s2, s.s3, s.s4,
                   s.s5, s.s6, s.s7);
    *total = s.sf;
    return (float16)(0.0f, s.s0, s.s1, s.s2, s.s3, s.s4, s.s5, s.s6, s.s7, s.s8, s.s9, s.sa, s.sb,
                     s.sc, s.sd, s.se);
}

/// out[o] += sum over k of e_k[o] * sum over i < o of x_k[i] in[i]. `factors` holds
/// [emission_0 .. emission_(rank-1), excitation_0 .. excitation_(rank-1)][lane] for one phase.
void reradiation_factored(const float16* in, float16* out, __global const float* factors,
                          uint rank) {
    for (uint k = 0u; k < rank; ++k) {
        __global const float* emission = factors + k * LANES;
        __global const float* excitation = factors + (rank + k) * LANES;
        float carried = 0.0f;
        for (uint c = 0u; c < CHUNKS; ++c) {
            float total;
            const float16 before =
                reradiation_exclusive_sum(vload16(c, excitation) * in[c], &total);
            out[c] += vload16(c, emission) * (before + carried);
            carried += total;
        }
    }
}

/// out[o] += sum over i of M[o][i] in[i], M by columns: matrix[i * LANES + o].
void reradiation_dense(const float16* in, float16* out, __global const float* matrix) {
    for (uint i = 0u; i < LANES; ++i) {
        const float excitation = ((const float*)in)[i];
        if (excitation != 0.0f)
            for (uint c = 0u; c < CHUNKS; ++c)
                out[c] += vload16(c, matrix + i * LANES) * excitation;
    }
}

#endif
