// The part of a material that never reaches the substrate: mirror, top lobe, deeper lobes,
// residual.
#ifndef RERADIANT_GATHER_SPECULAR_H
#define RERADIANT_GATHER_SPECULAR_H

#include "kernels/stack/layer_stack.h"
#include "kernels/stages/gather_lanes.h"

#if FEATURE_MODEL_A_PER_LANE
/// IOR ratios of one lane: add a layer's eta_lanes.
__global const float* lane_etas(const GatherContext* context, uint lane) {
    return context->tables + (size_t)context->phase * LANES + lane;
}

/// Computes, per lane, the shares of light that model A's interfaces let in along wi (way_in) and
/// out along wo (way_out), as in LayerDescent.
void model_a_ways(const GatherContext* context, Vec3 wi, Vec3 wo, Lanes* way_in, Lanes* way_out) {
    for (uint i = 0u; i < PATH_CHUNKS * PATH_WIDTH; ++i) {
        const LayerDescent descent =
            model_a_descend(context->layers, context->material.layer_count,
                            lane_etas(context, path_lane(context, i)), wi, wo);
        ((float*)way_in)[i] = descent.way_in;
        ((float*)way_out)[i] = descent.way_out;
    }
}

#if FEATURE_DEEPER_LOBES
/// Returns the factor that the tables add to a deeper lobe of model A in one lane: albedo (1 -
/// exp(-tau (1 / cos_i + 1 / cos_o))) of a slab, the tabulated reflectance of facets, else 1.
float model_a_tabulated_lane(const GatherContext* context, LobeRecord lobe, LayerFacet facet,
                             uint lane) {
#if FEATURE_SCATTERING_SLABS
    if (lobe.slab != NO_INDEX) {
        __global const float* slab = context->tables + lobe.slab + context->phase * LANES + lane;
        return -slab[context->phases * LANES] *
               expm1(-slab[0] * (1.0f / facet.wi.z + 1.0f / facet.wo.z));
    }
#endif
#if FEATURE_TABULATED_REFLECTANCE
    const uint offset = context->layers[lobe.layer].reflectance;
    if (offset != NO_INDEX) {
        const TableStencil s = table_stencil(facet.cos_h);
        __global const float* rows = context->tables + offset +
                                     ((size_t)context->phase * TABLE_NODES + s.node) * LANES + lane;
        return s.w0 * rows[0] + s.w1 * rows[LANES] + s.w2 * rows[2 * LANES] +
               s.w3 * rows[3 * LANES];
    }
#endif
    return 1.0f;
}

/// A deeper lobe of model A for one vector of lanes.
Lanes model_a_lobe(const GatherContext* context, LobeRecord lobe, Vec3 wi, Vec3 wo, uint chunk) {
    Lanes result;
    for (uint i = 0u; i < PATH_WIDTH; ++i) {
        const uint lane = path_lane(context, chunk * PATH_WIDTH + i);
        __global const float* etas = lane_etas(context, lane);
        const LayerFacet facet = model_a_facet(context->layers, lobe.layer, etas, wi, wo);
        const float value = model_a_nested_lobe(context->layers, lobe, etas, facet);
        ((float*)&result)[i] =
            value > 0.0f ? value * model_a_tabulated_lane(context, lobe, facet, lane) : 0.0f;
    }
    return result;
}
#endif
#endif

#if FEATURE_ROUGH
/// Lanes of the rough top lobe's reflectance where it depends on wavelength, 1 where `shade` had
/// it.
Lanes top_reflectance(const GatherContext* context, Vec3 wi, Vec3 wo, uint chunk) {
#if FEATURE_DISPERSION || FEATURE_TABULATED_REFLECTANCE
    const LayerRecord top = context->layers[0];
    const Vec3 h = vec3_normalise(vec3_add(wi, wo));
    const float cos_h = fmax((float)vec3_dot(wo, h), 0.0f);
#if FEATURE_TABULATED_REFLECTANCE
    if (top.reflectance != NO_INDEX)
        return facet_reflectance(context, top.reflectance, cos_h, chunk);
#endif
#if FEATURE_DISPERSION
    if (top.eta_lanes != NO_INDEX)
        return fresnel_lanes(context,
                             context->tables + top.eta_lanes + (size_t)context->phase * LANES,
                             cos_h, chunk);
#endif
#endif
    return (Lanes)(1.0f);
}
#endif

#if FEATURE_MODEL_A_TABULATED
/// Returns the factor that the tables add to a deeper lobe of model A for one vector of lanes, as
/// model_a_tabulated_lane does for one lane.
Lanes model_a_tabulated(const GatherContext* context, LobeRecord lobe, Vec3 wi, Vec3 wo,
                        uint chunk) {
    const LayerFacet facet = model_a_facet(context->layers, lobe.layer, 0, wi, wo);
#if FEATURE_SCATTERING_SLABS
    if (lobe.slab != NO_INDEX) {
        __global const float* slab = context->tables + lobe.slab + context->phase * LANES;
        const Lanes depth = path_row(context, slab, chunk);
        const Lanes albedo = path_row(context, slab + (size_t)context->phases * LANES, chunk);
        return -albedo * expm1(-depth * (float)(REAL(1.0) / facet.wi.z + REAL(1.0) / facet.wo.z));
    }
#endif
#if FEATURE_TABULATED_REFLECTANCE
    if (context->layers[lobe.layer].reflectance != NO_INDEX)
        return facet_reflectance(context, context->layers[lobe.layer].reflectance, facet.cos_h,
                                 chunk);
#endif
    return (Lanes)(1.0f);
}
#endif

#if FEATURE_DEEPER_LOBES
/// Lanes of a deeper lobe beyond its scalar value and its amplitudes.
Lanes lobe_lanes(const GatherContext* context, uint l, Vec3 wi, Vec3 wo, uint chunk) {
#if FEATURE_MODEL_A_PER_LANE
    if (context->material.weidlich_wilkie == MODEL_A_PER_LANE)
        return model_a_lobe(context, context->lobes[l], wi, wo, chunk);
#endif
#if FEATURE_MODEL_A_TABULATED
    if (context->material.weidlich_wilkie == MODEL_A)
        return model_a_tabulated(context, context->lobes[l], wi, wo, chunk);
#endif
    return (Lanes)(1.0f);
}
#endif

#if FEATURE_SHEETS
/// Adds what a direction on the far side of a sheet brings straight through it, by the lobe of its
/// rough faces, and scattered.
void gather_through(const GatherContext* context, DirectionRecord d, TableStencil so,
                    const Lanes* radiance, Lanes* up) {
    const TableStencil si = table_stencil(-d.z);
    const MaterialRecord m = context->material;
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        Lanes through = (Lanes)(0.0f);
        if (d.delta > 0.0f && m.through_delta != NO_INDEX)
            through += d.delta * stack_lookup(context, m.through_delta, so, c);
        if (d.top > 0.0f)
            through += d.top * stack_lookup(context, m.through_lobe_far, si, c) *
                       stack_lookup(context, m.through_lobe_own, so, c);
        if (d.residual > 0.0f && m.through_own != NO_INDEX)
            through += d.residual * stack_lookup(context, m.through_far, si, c) *
                       stack_lookup(context, m.through_own, so, c);
        up[c] += radiance[c] * through;
    }
}
#endif

/// Adds what one direction brings to the substrate (`down`; `first`: what meets it once, see
/// oren-nayar) and to the specular part (`up`).
void gather_direction(const GatherContext* context, DirectionRecord d, Vec3 wo, TableStencil so,
                      __global const float* lobe_weights, const Lanes* radiance, Lanes* down,
                      Lanes* first, Lanes* up) {
#if FEATURE_SHEETS
    if (d.z < 0.0f) {
        gather_through(context, d, so, radiance, up);
        return;
    }
#endif
    const TableStencil si = table_stencil(d.z);
    const MaterialRecord m = context->material;
    const Vec3 wi = vec3(d.x, d.y, d.z);
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        const Lanes incident = radiance[c];
        if (d.diffuse > 0.0f) {
            const Lanes through = incident * stack_lookup(context, m.transmission, si, c);
            down[c] += d.diffuse * through;
#if FEATURE_OREN_NAYAR
            first[c] += d.first * through;
#endif
        }
        Lanes specular = (Lanes)(0.0f);
#if FEATURE_SMOOTH
        if (d.delta > 0.0f)
            specular += d.delta * stack_lookup(context, m.delta, so, c);
#endif
#if FEATURE_ROUGH
        if (d.top > 0.0f)
            specular += d.top * top_reflectance(context, wi, wo, c);
#endif
#if FEATURE_ROUGH || FEATURE_DEEPER_LOBES || FEATURE_SCATTERING_SLABS
        if (m.residual != NO_INDEX && d.residual > 0.0f)
            specular += d.residual * stack_lookup(context, m.residual, si, c) *
                        stack_lookup(context, m.residual, so, c);
#endif
#if FEATURE_DEEPER_LOBES
        const uint size = TABLE_NODES * (m.spectral ? context->phases * LANES : 1u);
        for (uint l = 0u; l < m.lobe_count; ++l)
            if (lobe_weights[l] > 0.0f)
                specular += lobe_weights[l] * stack_lookup(context, m.amplitude + l * size, si, c) *
                            stack_lookup(context, m.amplitude + l * size, so, c) *
                            lobe_lanes(context, l, wi, wo, c);
#endif
        up[c] += incident * specular;
    }
}

#endif
