// Computes what the substrate does to the light that reaches it: reflectance, re-radiation, its way
// out.
#ifndef RERADIANT_GATHER_SUBSTRATE_H
#define RERADIANT_GATHER_SUBSTRATE_H

#include "kernels/stages/gather_lanes.h"
#include "kernels/stages/gather_specular.h"

#if FEATURE_REFLECTANCE_IMAGE
/// A reflectance rho coloured by an image: scale * rho / (1 - r rho) per lane, and what met an
/// Oren-Nayar substrate once.
void coloured_substrate(const GatherContext* context, const Lanes* down, const Lanes* first,
                        Lanes* emitted) {
    const MaterialRecord m = context->material;
    float mean = 1.0f;
#if FEATURE_OREN_NAYAR
    const int has_first = m.first_diagonal != NO_INDEX;
    if (has_first)
        mean = oren_nayar_mean_albedo(m.sigma);
#endif
    const size_t size = (size_t)context->phases * LANES;
    __global const float* scale = context->tables + m.diagonal + context->phase * LANES;
    __global const float* r = context->tables + m.image_reflectance + context->phase * LANES;
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        Lanes rho = (Lanes)(0.0f);
        for (uint k = 0u; k < 3u; ++k)
            rho += context->colour[3u + k] * path_row(context, r + (k + 1u) * size, c);
        emitted[c] = mean * down[c] * path_row(context, scale, c) * rho /
                     (1.0f - path_row(context, r, c) * rho);
#if FEATURE_OREN_NAYAR
        if (has_first)
            emitted[c] += first[c] * path_row(context, scale, c) * rho;
#endif
    }
}
#endif

#if FEATURE_HERO
/// emitted += what leaves of `down` at the sampled excitations.
void apply_sampled_operator(const GatherContext* context, __global const float* on_diagonal,
                            uint factors, uint dense, Lanes down, Lanes* emitted) {
    const HeroLanes to = context->leaving, from = context->incoming;
    *emitted += hero_row(to, on_diagonal) * hero_unshifted(to, from, down);
    const uint rank = context->material.rank;
    if (rank > 0u)
        *emitted += hero_factored(
            to, from, down,
            context->tables + factors + (size_t)context->phase * (2u * rank * LANES), rank);
#if FEATURE_DENSE_MATRIX
    if (dense != NO_INDEX)
        *emitted += hero_dense(to, from, down,
                               context->tables + dense + (size_t)context->phase * (LANES * LANES));
#endif
}
#endif

/// emitted += an operator of the substrate, for one phase.
void apply_operator(const GatherContext* context, uint diagonal, uint factors, uint dense,
                    const Lanes* down, Lanes* emitted) {
    __global const float* on_diagonal = context->tables + diagonal + context->phase * LANES;
#if FEATURE_HERO
    if (context->material.shift != NO_INDEX) {
        apply_sampled_operator(context, on_diagonal, factors, dense, *down, emitted);
        return;
    }
#endif
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        emitted[c] += path_row(context, on_diagonal, c) * down[c];
#if FEATURE_FLUORESCENCE && !FEATURE_HERO
    const uint rank = context->material.rank;
    if (rank > 0u)
        reradiation_factored(
            down, emitted, context->tables + factors + (size_t)context->phase * (2u * rank * LANES),
            rank);
#if FEATURE_DENSE_MATRIX
    if (dense != NO_INDEX)
        reradiation_dense(down, emitted,
                          context->tables + dense + (size_t)context->phase * (LANES * LANES));
#endif
#endif
}

/// B: what the substrate sends up.
void substrate(const GatherContext* context, const Lanes* down, const Lanes* first,
               Lanes* emitted) {
    const MaterialRecord m = context->material;
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        emitted[c] = (Lanes)(0.0f);
#if FEATURE_REFLECTANCE_IMAGE
    if (m.reflectance_image != NO_INDEX) {
        coloured_substrate(context, down, first, emitted);
        return;
    }
#endif
    apply_operator(context, m.diagonal, m.factors, m.dense, down, emitted);
#if FEATURE_OREN_NAYAR
    if (m.first_diagonal != NO_INDEX)
        apply_operator(context, m.first_diagonal, m.first_factors, m.first_dense, first, emitted);
#endif
}

/// Adds T(o) times what the substrate sends up for `down` to the sum.
void leave_substrate(const GatherContext* context, TableStencil so, const Lanes* down,
                     const Lanes* first, Lanes* sum) {
#if FEATURE_HERO
    GatherContext leaving = *context;
    leaving.lanes = context->leaving;
    context = &leaving;
#endif
    Lanes emitted[PATH_CHUNKS];
    substrate(context, down, first, emitted);
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        sum[c] += stack_lookup(context, context->material.transmission, so, c) * emitted[c];
}

#if FEATURE_MODEL_A_PER_LANE
/// Adds to `sum` what model A sends out towards wo of the light that one direction brings to the
/// substrate (`down`, which is then set to 0): the way in acts at the excitation wavelength, the
/// way out at that of emission, so directions do not mix.
void leave_substrate_per_lane(const GatherContext* context, DirectionRecord d, Vec3 wo,
                              TableStencil so, Lanes* down, Lanes* sum) {
    Lanes way_in[PATH_CHUNKS], way_out[PATH_CHUNKS], left[PATH_CHUNKS];
    model_a_ways(context, vec3(d.x, d.y, d.z), wo, way_in, way_out);
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        down[c] *= way_in[c];
        left[c] = (Lanes)(0.0f);
    }
    leave_substrate(context, so, down, down, left); // model A has no `first`
#if FEATURE_HERO
    Lanes unused[PATH_CHUNKS];
    GatherContext leaving = *context;
    leaving.lanes = context->leaving;
    model_a_ways(&leaving, vec3(d.x, d.y, d.z), wo, unused, way_out);
#endif
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        sum[c] += way_out[c] * left[c];
        down[c] = (Lanes)(0.0f);
    }
}
#endif

#endif
