// Light that a stack with dyes in its slabs sends out again, dyes and substrate together: sum over
// channels b, a of T_b(wo) B(b lo, a li) T_a(wi). A channel's T says what a direction's light
// brings to the depths of the stack (host/render/tables/dyed_operator.h).
#ifndef RERADIANT_GATHER_DYES_H
#define RERADIANT_GATHER_DYES_H

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

/// Adds what leaves towards wo to the sum. Columns of the coupling are [channel a][lane i], their
/// rows [channel b][lane o].
static void leave_dyes(const GatherContext* context, TableStencil so, const DyeChannels* reached,
                       Lanes* sum) {
    const uint channels = context->material.dye_channels;
    __global const float* coupling =
        context->tables + context->material.dye_coupling +
        (size_t)context->phase * (channels * LANES) * (channels * LANES);
    DyeChannels sent;
    clear_dyes(&sent);
    for (uint a = 0u; a < channels; ++a) {
        for (uint i = 0u; i < LANES; ++i) {
            const float excitation = ((const float*)reached->lanes[a])[i];
            if (excitation == 0.0f)
                continue;
            __global const float* column = coupling + (size_t)(a * LANES + i) * (channels * LANES);
            const uint first = context->material.dyes_shift_up ? i / WIDTH : 0u;
            for (uint b = 0u; b < channels; ++b)
                for (uint c = first; c < CHUNKS; ++c)
                    sent.lanes[b][c] += vload16(c, column + b * LANES) * excitation;
        }
    }
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        Lanes left = (Lanes)(0.0f);
        for (uint b = 0u; b < channels; ++b)
            left += dye_channel(context, context->material.dyes, b, so, c) * sent.lanes[b][c];
        sum[c] += left < 0.0f ? (Lanes)(0.0f) : left;
    }
}

#endif
