// Light that a stack with dyes in its slabs sends out again, dyes and substrate together: sum over
// channels b, a of T_b(wo) B(b lo, a li) T_a(wi). A channel's T says what a direction's light
// brings to the depths of the stack (host/render/tables/dyed_operator.h).
#ifndef RERADIANT_GATHER_DYES_H
#define RERADIANT_GATHER_DYES_H

#include "kernels/stack/reradiation.h"
#include "kernels/stages/gather_lanes.h"

/// What reaches the channels of a vertex, [channel][vector].
typedef struct {
    Lanes lanes[DYE_CHANNELS][PATH_CHUNKS];
} DyeChannels;

static void clear_dyes(DyeChannels* reached) {
    for (uint a = 0u; a < DYE_CHANNELS; ++a)
        for (uint c = 0u; c < PATH_CHUNKS; ++c)
            reached->lanes[a][c] = (Lanes)(0.0f);
}

/// A channel's function of the direction for one vector of lanes. Unlike shares it may be negative.
static Lanes dye_channel(const GatherContext* context, uint dyes, uint channel, TableStencil s,
                         uint chunk) {
    const size_t table = (size_t)context->phases * TABLE_NODES * LANES;
    __global const float* rows = context->tables + dyes + channel * table +
                                 ((size_t)context->phase * TABLE_NODES + s.node) * LANES;
    return (float)s.w0 * path_row(context, rows, chunk) +
           (float)s.w1 * path_row(context, rows + LANES, chunk) +
           (float)s.w2 * path_row(context, rows + 2 * LANES, chunk) +
           (float)s.w3 * path_row(context, rows + 3 * LANES, chunk);
}

/// Adds what one direction brings, `weight` cos / pdf; `dyes` is the table of its side.
static void reach_dyes(const GatherContext* context, uint dyes, TableStencil si, float weight,
                       const Lanes* radiance, DyeChannels* reached) {
    for (uint a = 0u; a < context->material.dye_channels; ++a)
        for (uint c = 0u; c < PATH_CHUNKS; ++c)
            reached->lanes[a][c] += weight * radiance[c] * dye_channel(context, dyes, a, si, c);
}

/// What a coupling between lanes entry by entry sends.
static void couple_dyes_densely(__global const float* coupling, uint channels, uint shifts_up,
                                const DyeChannels* reached, DyeChannels* sent) {
    for (uint a = 0u; a < channels; ++a) {
        for (uint i = 0u; i < LANES; ++i) {
            const float excitation = ((const float*)reached->lanes[a])[i];
            if (excitation == 0.0f)
                continue;
            __global const float* column = coupling + (size_t)(a * LANES + i) * (channels * LANES);
            const uint first = shifts_up ? i / WIDTH : 0u;
            for (uint b = 0u; b < channels; ++b)
                for (uint c = first; c < CHUNKS; ++c)
                    sent->lanes[b][c] += vload16(c, column + b * LANES) * excitation;
        }
    }
}

/// What a coupling within lanes and by terms of a product sends: a running sum for each term.
static void couple_dyes(__global const float* coupling, uint channels, uint terms,
                        const DyeChannels* reached, DyeChannels* sent) {
    for (uint b = 0u; b < channels; ++b)
        for (uint a = 0u; a < channels; ++a)
            for (uint c = 0u; c < CHUNKS; ++c)
                sent->lanes[b][c] +=
                    vload16(c, coupling + (b * channels + a) * LANES) * reached->lanes[a][c];
    for (uint k = 0u; k < terms; ++k) {
        __global const float* taken = coupling + (channels * channels + 2u * k * channels) * LANES;
        __global const float* emission = taken + channels * LANES;
        float carried = 0.0f;
        for (uint c = 0u; c < CHUNKS; ++c) {
            Lanes here = (Lanes)(0.0f);
            for (uint a = 0u; a < channels; ++a)
                here += vload16(c, taken + a * LANES) * reached->lanes[a][c];
            float total;
            const Lanes before = reradiation_exclusive_sum(here, &total) + carried;
            for (uint b = 0u; b < channels; ++b)
                sent->lanes[b][c] += vload16(c, emission + b * LANES) * before;
            carried += total;
        }
    }
}

/// Adds what leaves towards wo to the sum.
static void leave_dyes(const GatherContext* context, TableStencil so, const DyeChannels* reached,
                       Lanes* sum) {
    const MaterialRecord m = context->material;
    const uint channels = m.dye_channels;
    __global const float* couplings = context->tables + m.dye_coupling;
    DyeChannels sent;
    clear_dyes(&sent);
    if (m.dye_terms > 0u)
        couple_dyes(couplings + (size_t)context->phase *
                                    ((channels * channels + 2u * m.dye_terms * channels) * LANES),
                    channels, m.dye_terms, reached, &sent);
    else
        couple_dyes_densely(couplings + (size_t)context->phase *
                                            ((size_t)(channels * LANES) * (channels * LANES)),
                            channels, m.dyes_shift_up, reached, &sent);
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        Lanes left = (Lanes)(0.0f);
        for (uint b = 0u; b < channels; ++b)
            left += dye_channel(context, context->material.dyes, b, so, c) * sent.lanes[b][c];
        sum[c] += left < 0.0f ? (Lanes)(0.0f) : left;
    }
}

#endif
