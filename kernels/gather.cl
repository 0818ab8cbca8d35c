// Stage 5: radiance of each path, from its last vertex back to the camera. At every vertex one
// linear operator acts on a vector of wavelengths: L = T(o) B (T(i) L_in) + specular, where B
// holds the substrate with all its interreflections (DESIGN 2 B, 3).
#include "kernels/features.h"
#include "kernels/fresnel.h"
#include "kernels/layer_stack.h"
#include "kernels/portable.h"
#include "kernels/reradiation.h"
#include "kernels/shared.h"
#include "kernels/table.h"

typedef struct {
    MaterialRecord material;
    __global const LayerRecord* layers;
    __global const float* tables;
    uint phase;
    uint phases;
} GatherContext;

float grey_lookup(__global const float* table, TableStencil s) {
    return s.w0 * table[s.node] + s.w1 * table[s.node + 1u] + s.w2 * table[s.node + 2u] +
           s.w3 * table[s.node + 3u];
}

/// Table value for 16 lanes: the same number for a grey stack.
float16 stack_lookup(const GatherContext* context, uint offset, TableStencil s, uint chunk) {
#if FEATURE_SPECTRAL_STACK
    if (context->material.spectral) {
        __global const float* rows = context->tables + offset +
                                     ((size_t)context->phase * TABLE_NODES + s.node) * LANES +
                                     chunk * WIDTH;
        return s.w0 * vload16(0, rows) + s.w1 * vload16(0, rows + LANES) +
               s.w2 * vload16(0, rows + 2 * LANES) + s.w3 * vload16(0, rows + 3 * LANES);
    }
#endif
    return (float16)(grey_lookup(context->tables + offset, s));
}

#if FEATURE_DISPERSION
/// Fresnel reflectance per lane; lanes are done one by one, dispersive tops are rare.
float16 fresnel_lanes(__global const float* eta, float cos_h) {
    float16 result;
    for (uint i = 0u; i < WIDTH; ++i)
        ((float*)&result)[i] = fresnel_dielectric(cos_h, eta[i]);
    return result;
}
#endif

/// Adds what one direction brings to the substrate (`down`) and to the specular part (`up`).
void gather_direction(const GatherContext* context, DirectionRecord d, Vec3 wo, TableStencil so,
                      __global const float* lobe_weights, const float16* radiance, float16* down,
                      float16* up) {
    const TableStencil si = table_stencil(d.z);
    const MaterialRecord m = context->material;
#if FEATURE_DISPERSION
    const Vec3 h = vec3_normalise(vec3(wo.x + d.x, wo.y + d.y, wo.z + d.z));
    const float cos_h = fmax(vec3_dot(wo, h), 0.0f);
#endif
    for (uint c = 0u; c < CHUNKS; ++c) {
        const float16 incident = radiance[c];
        if (d.diffuse > 0.0f)
            down[c] += incident * (d.diffuse * stack_lookup(context, m.transmission, si, c));
        float16 specular = (float16)(0.0f);
#if FEATURE_SMOOTH
        if (d.delta > 0.0f)
            specular += d.delta * stack_lookup(context, m.delta, so, c);
#endif
#if FEATURE_ROUGH
#if FEATURE_DISPERSION
        if (d.top > 0.0f && context->layers[0].eta_lanes != NO_INDEX)
            specular += d.top * fresnel_lanes(context->tables + context->layers[0].eta_lanes +
                                                  (size_t)context->phase * LANES + c * WIDTH,
                                              cos_h);
        else
#endif
            specular += d.top;
#endif
#if FEATURE_ROUGH || FEATURE_DEEPER_LOBES
        if (m.residual != NO_INDEX && d.diffuse > 0.0f)
            specular += d.diffuse * stack_lookup(context, m.residual, si, c) *
                        stack_lookup(context, m.residual, so, c);
#endif
#if FEATURE_DEEPER_LOBES
        const uint size = TABLE_NODES * (m.spectral ? context->phases * LANES : 1u);
        for (uint l = 0u; l < m.lobe_count; ++l)
            if (lobe_weights[l] > 0.0f)
                specular += lobe_weights[l] * stack_lookup(context, m.amplitude + l * size, si, c) *
                            stack_lookup(context, m.amplitude + l * size, so, c);
#endif
        up[c] += incident * specular;
    }
}

/// B: what the substrate sends up, for one phase.
void substrate(const GatherContext* context, const float16* down, float16* emitted) {
    const MaterialRecord m = context->material;
    __global const float* diagonal = context->tables + m.diagonal + context->phase * LANES;
    for (uint c = 0u; c < CHUNKS; ++c)
        emitted[c] = vload16(c, diagonal) * down[c];
#if FEATURE_FLUORESCENCE
    if (m.rank > 0u)
        reradiation_factored(
            down, emitted,
            context->tables + m.factors + (size_t)context->phase * (2u * m.rank * LANES), m.rank);
#if FEATURE_DENSE_MATRIX
    if (m.dense != NO_INDEX)
        reradiation_dense(down, emitted,
                          context->tables + m.dense + (size_t)context->phase * (LANES * LANES));
#endif
#endif
}

/// Radiance that leaves a vertex; `radiance` holds what comes along `next` and receives the sum.
void gather_vertex(const GatherContext* context, const VertexRecord* vertex, int lit,
                   __global const float* light_spectrum, __global const float* vertex_lobes,
                   float16* radiance) {
    float16 down[CHUNKS], up[CHUNKS], emitted[CHUNKS];
    for (uint c = 0u; c < CHUNKS; ++c) {
        down[c] = (float16)(0.0f);
        up[c] = (float16)(0.0f);
    }
    const Vec3 wo = vec3(vertex->out_x, vertex->out_y, vertex->out_z);
    const TableStencil so = table_stencil(wo.z);
    if (vertex->has_next)
        gather_direction(context, vertex->next, wo, so, vertex_lobes, radiance, down, up);
#if FEATURE_LIGHT_SAMPLING
    if (lit) {
        for (uint c = 0u; c < CHUNKS; ++c)
            radiance[c] = vload16(c, light_spectrum);
        gather_direction(context, vertex->towards_light, wo, so, vertex_lobes + LOBES, radiance,
                         down, up);
    }
#endif
    substrate(context, down, emitted);
    for (uint c = 0u; c < CHUNKS; ++c)
        radiance[c] =
            stack_lookup(context, context->material.transmission, so, c) * emitted[c] + up[c];
}

__kernel void gather(__global float* radiance_out, __global const PathState* paths,
                     __global const VertexRecord* vertices, __global const RayRecord* shadow_rays,
                     __global const float* lobe_weights, __global const MaterialRecord* materials,
                     __global const LayerRecord* layers, __global const LightRecord* lights,
                     __global const float* tables, uint path_count, uint capacity, uint phases) {
    const uint path = (uint)get_global_id(0);
    if (path >= path_count)
        return;
    const PathState state = paths[path];
    GatherContext context;
    context.tables = tables;
    context.phase = state.phase;
    context.phases = phases;
    float16 radiance[CHUNKS];
    for (uint c = 0u; c < CHUNKS; ++c)
        radiance[c] = (float16)(0.0f);
    for (uint depth = state.vertex_count; depth-- > 0u;) {
        const size_t slot = (size_t)depth * capacity + path;
        const VertexRecord vertex = vertices[slot];
        if (vertex.material == NO_INDEX) {
            __global const float* spectrum =
                tables + lights[vertex.emitter].spectrum + state.phase * LANES;
            for (uint c = 0u; c < CHUNKS; ++c)
                radiance[c] = vertex.emitted * vload16(c, spectrum);
            continue;
        }
        context.material = materials[vertex.material];
        context.layers = layers + context.material.first_layer;
        int lit = 0;
        __global const float* spectrum = tables;
#if FEATURE_LIGHT_SAMPLING
        lit = vertex.light != NO_INDEX && shadow_rays[slot].t_far >= 0.0f;
        if (lit)
            spectrum = tables + lights[vertex.light].spectrum + state.phase * LANES;
#endif
        gather_vertex(&context, &vertex, lit, spectrum, lobe_weights + slot * (2u * LOBES),
                      radiance);
    }
    for (uint c = 0u; c < CHUNKS; ++c)
        vstore16(radiance[c], c, radiance_out + (size_t)path * LANES);
}
