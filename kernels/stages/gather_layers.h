// Radiance that leaves a vertex of a material whose model is in closed form: L = T(o) B (T(i) L_in)
// + specular, where B holds the substrate with all its interreflections (host/README.md).
#ifndef RERADIANT_GATHER_LAYERS_H
#define RERADIANT_GATHER_LAYERS_H

#if FEATURE_DYES
#include "kernels/stages/gather_dyes.h"
#endif
#include "kernels/stages/gather_lanes.h"
#include "kernels/stages/gather_specular.h"
#include "kernels/stages/gather_substrate.h"

/// These are the vectors that come to a vertex: `down` to the substrate, `first` to meet it once
/// (oren-nayar), `up` by the specular part, `left` what is known to leave. Without Oren-Nayar
/// `first` is `down`, and without hero wavelengths `up` leaves as it is.
typedef struct {
    Lanes down[PATH_CHUNKS], up[PATH_CHUNKS];
#if FEATURE_OREN_NAYAR
    Lanes first[PATH_CHUNKS];
#endif
#if FEATURE_HERO
    Lanes left[PATH_CHUNKS]; // `up` is at other wavelengths than what leaves
#endif
#if FEATURE_DYES
    DyeChannels dyes; // instead of `down`
#endif
} GatherSums;

#if FEATURE_OREN_NAYAR
#define GATHER_FIRST first
#else
#define GATHER_FIRST down
#endif
#if FEATURE_HERO
#define GATHER_LEFT left
#else
#define GATHER_LEFT up
#endif

static void clear_sums(GatherSums* sums) {
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        sums->down[c] = (Lanes)(0.0f);
        sums->GATHER_FIRST[c] = (Lanes)(0.0f);
        sums->up[c] = (Lanes)(0.0f);
        sums->GATHER_LEFT[c] = (Lanes)(0.0f);
    }
#if FEATURE_DYES
    clear_dyes(&sums->dyes);
#endif
}

/// Adds what one direction brings, its weights in `d` and `lobe_weights`.
static void gather_one(const GatherContext* context, DirectionRecord d, Vec3 wo, TableStencil so,
                       __global const float* lobe_weights, const Lanes* radiance,
                       GatherSums* sums) {
#if FEATURE_DYES
    if (context->material.dyes != NO_INDEX) {
        reach_dyes(context, d.z < 0.0f ? context->material.dyes_far : context->material.dyes,
                   table_stencil(fabs(d.z)), d.diffuse, radiance, &sums->dyes);
        d.diffuse = 0.0f;
    }
#endif
    gather_direction(context, d, wo, so, lobe_weights, radiance, sums->down, sums->GATHER_FIRST,
                     sums->up);
#if FEATURE_MODEL_A_PER_LANE
    if (context->material.weidlich_wilkie == MODEL_A_PER_LANE)
        leave_substrate_per_lane(context, d, wo, so, sums->down, sums->GATHER_LEFT);
#endif
}

/// `radiance` holds what comes along `next` and receives what leaves the vertex.
static void gather_layers(const GatherScene* scene, const GatherContext* context,
                          const VertexRecord* vertex, size_t slot, int lit, Lanes* radiance) {
    const Vec3 wo = vec3(vertex->out_x, vertex->out_y, vertex->out_z);
    const TableStencil so = table_stencil(wo.z);
    __global const float* lobe_weights = scene->lobe_weights + slot * (2u * LOBES);
    GatherSums sums;
    clear_sums(&sums);
#if FEATURE_HERO
    radiance[0] *= context->weights;
#endif
    if (vertex->has_next)
        gather_one(context, vertex->next, wo, so, lobe_weights, radiance, &sums);
#if FEATURE_LIGHT_SAMPLING
    if (lit) {
        for (uint c = 0u; c < PATH_CHUNKS; ++c)
            radiance[c] = light_found(scene, context, vertex->light, slot, c);
#if FEATURE_HERO
        radiance[0] *= context->weights;
#endif
        gather_one(context, vertex->towards_light, wo, so, lobe_weights + LOBES, radiance, &sums);
    }
#endif
#if FEATURE_DYES
    if (context->material.dyes != NO_INDEX)
        leave_dyes(context, so, &sums.dyes, sums.GATHER_LEFT);
    else
#endif
        leave_substrate(context, so, sums.down, sums.GATHER_FIRST, sums.GATHER_LEFT);
#if FEATURE_HERO
    sums.left[0] += context->material.shift == NO_INDEX
                        ? sums.up[0]
                        : hero_unshifted(context->leaving, context->incoming, sums.up[0]);
#endif
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance[c] = sums.GATHER_LEFT[c];
}

#endif
