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
#if FEATURE_WALK
#include "kernels/walk_events.h"
#endif

typedef struct {
    MaterialRecord material;
    __global const LayerRecord* layers;
    __global const LobeRecord* lobes;
    __global const float* tables;
    __global const float* colour;              ///< of the vertex (VERTEX_COLOURS)
    __global const WalkPartRecord* walk_parts; ///< of the material, where it is walked through
    uint phase;
    uint phases;
} GatherContext;

float grey_lookup(__global const float* table, TableStencil s) {
    return s.w0 * table[s.node] + s.w1 * table[s.node + 1u] + s.w2 * table[s.node + 2u] +
           s.w3 * table[s.node + 3u];
}

/// Value of a table by lanes, [phase][node][lane], for 16 of them.
float16 spectral_lookup(const GatherContext* context, uint offset, TableStencil s, uint chunk) {
    __global const float* rows = context->tables + offset +
                                 ((size_t)context->phase * TABLE_NODES + s.node) * LANES +
                                 chunk * WIDTH;
    return s.w0 * vload16(0, rows) + s.w1 * vload16(0, rows + LANES) +
           s.w2 * vload16(0, rows + 2 * LANES) + s.w3 * vload16(0, rows + 3 * LANES);
}

/// Table value for 16 lanes: the same number for a grey stack.
float16 stack_lookup(const GatherContext* context, uint offset, TableStencil s, uint chunk) {
#if FEATURE_SPECTRAL_STACK
    if (context->material.spectral)
        return spectral_lookup(context, offset, s, chunk);
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

#if FEATURE_TABULATED_REFLECTANCE
/// Reflectance of a part's facets for 16 lanes, tabulated over the cosine at the facet.
float16 facet_reflectance(const GatherContext* context, uint offset, float cos_h, uint chunk) {
    return spectral_lookup(context, offset, table_stencil(cos_h), chunk);
}
#endif

#if FEATURE_DISPERSION && FEATURE_WEIDLICH_WILKIE
#define FEATURE_MODEL_A_PER_LANE 1

/// IOR ratios of one lane: add a layer's eta_lanes.
__global const float* lane_etas(const GatherContext* context, uint lane) {
    return context->tables + (size_t)context->phase * LANES + lane;
}

/// What model A's interfaces let in and out between two directions, per lane.
void model_a_ways(const GatherContext* context, Vec3 wi, Vec3 wo, float16* way_in,
                  float16* way_out) {
    for (uint lane = 0u; lane < LANES; ++lane) {
        const LayerDescent descent = layer_stack_descend(
            context->layers, context->material.layer_count, lane_etas(context, lane), wi, wo);
        ((float*)way_in)[lane] = descent.way_in;
        ((float*)way_out)[lane] = descent.way_out;
    }
}

#if FEATURE_DEEPER_LOBES
/// What the tables add to a deeper lobe of model A in one lane.
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

/// A deeper lobe of model A for 16 lanes.
float16 model_a_lobe(const GatherContext* context, LobeRecord lobe, Vec3 wi, Vec3 wo, uint chunk) {
    float16 result;
    for (uint i = 0u; i < WIDTH; ++i) {
        const uint lane = chunk * WIDTH + i;
        __global const float* etas = lane_etas(context, lane);
        const LayerFacet facet = layer_stack_facet(context->layers, lobe.layer, etas, wi, wo);
        const float value = layer_stack_nested_lobe(context->layers, lobe, etas, facet);
        ((float*)&result)[i] =
            value > 0.0f ? value * model_a_tabulated_lane(context, lobe, facet, lane) : 0.0f;
    }
    return result;
}
#endif
#else
#define FEATURE_MODEL_A_PER_LANE 0
#endif

#if FEATURE_ROUGH
/// Lanes of the rough top lobe's reflectance where it depends on wavelength, 1 where `shade` had
/// it.
float16 top_reflectance(const GatherContext* context, Vec3 wi, Vec3 wo, uint chunk) {
#if FEATURE_DISPERSION || FEATURE_TABULATED_REFLECTANCE
    const LayerRecord top = context->layers[0];
    const Vec3 h = vec3_normalise(vec3_add(wi, wo));
    const float cos_h = fmax(vec3_dot(wo, h), 0.0f);
#if FEATURE_TABULATED_REFLECTANCE
    if (top.reflectance != NO_INDEX)
        return facet_reflectance(context, top.reflectance, cos_h, chunk);
#endif
#if FEATURE_DISPERSION
    if (top.eta_lanes != NO_INDEX)
        return fresnel_lanes(context->tables + top.eta_lanes + (size_t)context->phase * LANES +
                                 chunk * WIDTH,
                             cos_h);
#endif
#endif
    return (float16)(1.0f);
}
#endif

#if FEATURE_DEEPER_LOBES && FEATURE_WEIDLICH_WILKIE &&                                             \
    (FEATURE_SCATTERING_SLABS || FEATURE_TABULATED_REFLECTANCE)
#define FEATURE_MODEL_A_TABULATED 1

/// What the tables add to a deeper lobe of model A for 16 lanes.
float16 model_a_tabulated(const GatherContext* context, LobeRecord lobe, Vec3 wi, Vec3 wo,
                          uint chunk) {
    const LayerFacet facet = layer_stack_facet(context->layers, lobe.layer, 0, wi, wo);
#if FEATURE_SCATTERING_SLABS
    if (lobe.slab != NO_INDEX) {
        __global const float* slab = context->tables + lobe.slab + context->phase * LANES;
        const float16 depth = vload16(chunk, slab);
        const float16 albedo = vload16(chunk, slab + (size_t)context->phases * LANES);
        return -albedo * expm1(-depth * (1.0f / facet.wi.z + 1.0f / facet.wo.z));
    }
#endif
#if FEATURE_TABULATED_REFLECTANCE
    if (context->layers[lobe.layer].reflectance != NO_INDEX)
        return facet_reflectance(context, context->layers[lobe.layer].reflectance, facet.cos_h,
                                 chunk);
#endif
    return (float16)(1.0f);
}
#else
#define FEATURE_MODEL_A_TABULATED 0
#endif

#if FEATURE_DEEPER_LOBES
/// Lanes of a deeper lobe beyond its scalar value and its amplitudes.
float16 lobe_lanes(const GatherContext* context, uint l, Vec3 wi, Vec3 wo, uint chunk) {
#if FEATURE_MODEL_A_PER_LANE
    if (context->material.weidlich_wilkie == MODEL_A_PER_LANE)
        return model_a_lobe(context, context->lobes[l], wi, wo, chunk);
#endif
#if FEATURE_MODEL_A_TABULATED
    if (context->material.weidlich_wilkie == MODEL_A)
        return model_a_tabulated(context, context->lobes[l], wi, wo, chunk);
#endif
    return (float16)(1.0f);
}
#endif

/// Adds what one direction brings to the substrate (`down`; `first`: what meets it once, see
/// oren-nayar) and to the specular part (`up`).
void gather_direction(const GatherContext* context, DirectionRecord d, Vec3 wo, TableStencil so,
                      __global const float* lobe_weights, const float16* radiance, float16* down,
                      float16* first, float16* up) {
    const TableStencil si = table_stencil(d.z);
    const MaterialRecord m = context->material;
    const Vec3 wi = vec3(d.x, d.y, d.z);
    for (uint c = 0u; c < CHUNKS; ++c) {
        const float16 incident = radiance[c];
        if (d.diffuse > 0.0f) {
            const float16 through = incident * stack_lookup(context, m.transmission, si, c);
            down[c] += d.diffuse * through;
#if FEATURE_OREN_NAYAR
            first[c] += d.first * through;
#endif
        }
        float16 specular = (float16)(0.0f);
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

#if FEATURE_REFLECTANCE_IMAGE
/// A reflectance rho coloured by an image: scale * rho / (1 - r rho) per lane, and what met an
/// Oren-Nayar substrate once.
void coloured_substrate(const GatherContext* context, const float16* down, const float16* first,
                        float16* emitted) {
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
    for (uint c = 0u; c < CHUNKS; ++c) {
        float16 rho = (float16)(0.0f);
        for (uint k = 0u; k < 3u; ++k)
            rho += context->colour[3u + k] * vload16(c, r + (k + 1u) * size);
        emitted[c] = mean * down[c] * vload16(c, scale) * rho / (1.0f - vload16(c, r) * rho);
#if FEATURE_OREN_NAYAR
        if (has_first)
            emitted[c] += first[c] * vload16(c, scale) * rho;
#endif
    }
}
#endif

/// emitted += an operator of the substrate, for one phase.
void apply_operator(const GatherContext* context, uint diagonal, uint factors, uint dense,
                    const float16* down, float16* emitted) {
    __global const float* on_diagonal = context->tables + diagonal + context->phase * LANES;
    for (uint c = 0u; c < CHUNKS; ++c)
        emitted[c] += vload16(c, on_diagonal) * down[c];
#if FEATURE_FLUORESCENCE
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
void substrate(const GatherContext* context, const float16* down, const float16* first,
               float16* emitted) {
    const MaterialRecord m = context->material;
    for (uint c = 0u; c < CHUNKS; ++c)
        emitted[c] = (float16)(0.0f);
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
void leave_substrate(const GatherContext* context, TableStencil so, const float16* down,
                     const float16* first, float16* sum) {
    float16 emitted[CHUNKS];
    substrate(context, down, first, emitted);
    for (uint c = 0u; c < CHUNKS; ++c)
        sum[c] += stack_lookup(context, context->material.transmission, so, c) * emitted[c];
}

#if FEATURE_MODEL_A_PER_LANE
/// What model A sends out towards wo of one direction's light on the substrate: the way in acts at
/// the excitation wavelength, the way out at that of emission, so directions do not mix.
void leave_substrate_per_lane(const GatherContext* context, DirectionRecord d, Vec3 wo,
                              TableStencil so, float16* down, float16* sum) {
    float16 way_in[CHUNKS], way_out[CHUNKS], left[CHUNKS];
    model_a_ways(context, vec3(d.x, d.y, d.z), wo, way_in, way_out);
    for (uint c = 0u; c < CHUNKS; ++c) {
        down[c] *= way_in[c];
        left[c] = (float16)(0.0f);
    }
    leave_substrate(context, so, down, down, left); // model A has no `first`
    for (uint c = 0u; c < CHUNKS; ++c) {
        sum[c] += way_out[c] * left[c];
        down[c] = (float16)(0.0f);
    }
}
#endif

/// Radiance of a light along the way it was seen, for 16 lanes.
float16 emission(__global const float* spectrum, __global const float* colour, uint is_image,
                 uint phases, uint chunk) {
#if FEATURE_ENVIRONMENT_IMAGE
    if (is_image) {
        const size_t size = (size_t)phases * LANES;
        return colour[0] * vload16(chunk, spectrum) + colour[1] * vload16(chunk, spectrum + size) +
               colour[2] * vload16(chunk, spectrum + 2u * size);
    }
#endif
    return vload16(chunk, spectrum);
}

/// Radiance that leaves a vertex; `radiance` holds what comes along `next` and receives the sum.
void gather_vertex(const GatherContext* context, const VertexRecord* vertex, int lit,
                   __global const float* light_spectrum, uint light_is_image,
                   __global const float* vertex_lobes, float16* radiance) {
    float16 down[CHUNKS], up[CHUNKS];
#if FEATURE_OREN_NAYAR
    float16 first[CHUNKS];
#else
    float16* const first = down;
#endif
    for (uint c = 0u; c < CHUNKS; ++c) {
        down[c] = (float16)(0.0f);
#if FEATURE_OREN_NAYAR
        first[c] = (float16)(0.0f);
#endif
        up[c] = (float16)(0.0f);
    }
    const Vec3 wo = vec3(vertex->out_x, vertex->out_y, vertex->out_z);
    const TableStencil so = table_stencil(wo.z);
#if FEATURE_MODEL_A_PER_LANE
    const int per_lane = context->material.weidlich_wilkie == MODEL_A_PER_LANE;
#endif
    if (vertex->has_next) {
        gather_direction(context, vertex->next, wo, so, vertex_lobes, radiance, down, first, up);
#if FEATURE_MODEL_A_PER_LANE
        if (per_lane)
            leave_substrate_per_lane(context, vertex->next, wo, so, down, up);
#endif
    }
#if FEATURE_LIGHT_SAMPLING
    if (lit) {
        for (uint c = 0u; c < CHUNKS; ++c)
            radiance[c] =
                emission(light_spectrum, context->colour, light_is_image, context->phases, c);
        gather_direction(context, vertex->towards_light, wo, so, vertex_lobes + LOBES, radiance,
                         down, first, up);
#if FEATURE_MODEL_A_PER_LANE
        if (per_lane)
            leave_substrate_per_lane(context, vertex->towards_light, wo, so, down, up);
#endif
    }
#endif
    leave_substrate(context, so, down, first, up);
    for (uint c = 0u; c < CHUNKS; ++c)
        radiance[c] = up[c];
}

#if FEATURE_WALK
/// exp(-(depth - sampled) length) of a slab for 16 lanes, times its scattering where it scattered.
float16 walk_slab_lanes(const GatherContext* context, WalkPartRecord part, float sampled,
                        float length, int scattered, uint chunk) {
    const uint lanes = context->phase * LANES;
    const float16 depth = vload16(chunk, context->tables + part.extinction + lanes);
    const float16 passed = exp((sampled - depth) * length);
#if FEATURE_SCATTERING_SLABS
    if (scattered)
        return passed * vload16(chunk, context->tables + part.scattering + lanes) / sampled;
#endif
    return passed;
}

/// L = M L; the material's operator is M / pi.
void walk_substrate(const GatherContext* context, float16* radiance) {
    float16 emitted[CHUNKS];
    substrate(context, radiance, radiance, emitted);
    for (uint c = 0u; c < CHUNKS; ++c)
        radiance[c] = PI_REAL * emitted[c];
}

/// What one event takes from the lanes of `light` or of the path.
float16 walk_event_lanes(const GatherContext* context, WalkEvent event, uint reference,
                         uint chunk) {
    const uint kind = WALK_KIND(event.code);
    const WalkPartRecord part = context->walk_parts[WALK_INDEX(event.code)];
#if FEATURE_TABULATED_REFLECTANCE
    if (kind == WALK_REFLECT || kind == WALK_LIGHT_REFLECT)
        return facet_reflectance(context, part.reflectance, event.value, chunk);
#endif
    const float sampled = kind == WALK_LIGHT_PASS ? 0.0f : part.references[reference];
    return walk_slab_lanes(context, part, sampled, event.value, kind == WALK_SCATTER, chunk);
}

/// Replays a walk from its last event to its first: `radiance` holds what comes in along the
/// path's next direction (weight included) and receives what leaves towards the camera; `light` is
/// the spectrum of the light that connections see.
void replay_walk(const GatherContext* context, WalkReader reader, uint reference, int lit,
                 const float16* light, float16* radiance) {
    float16 seen[CHUNKS];
    for (uint c = 0u; c < CHUNKS; ++c)
        seen[c] = light[c];
    WalkEvent event;
    while (walk_read(&reader, &event)) {
        const uint kind = WALK_KIND(event.code);
        if (kind == WALK_SUBSTRATE) {
            walk_substrate(context, radiance);
            continue;
        }
        for (uint c = 0u; c < CHUNKS; ++c) {
            if (kind == WALK_CONNECT) {
                if (lit)
                    radiance[c] += event.value * seen[c];
                seen[c] = light[c];
            } else if (kind < WALK_CONNECT) {
                radiance[c] *= walk_event_lanes(context, event, reference, c);
            } else if (lit) {
                seen[c] *= walk_event_lanes(context, event, reference, c);
            }
        }
    }
}

/// Radiance that leaves a vertex which was walked through; `radiance` as in gather_vertex.
void gather_walk(const GatherContext* context, const VertexRecord* vertex, WalkVertexRecord walk,
                 __global const WalkChunk* chunks, int lit, __global const float* light_spectrum,
                 uint light_is_image, float16* radiance) {
    float16 light[CHUNKS];
    const float weight = vertex->has_next ? walk.weight : 0.0f;
    for (uint c = 0u; c < CHUNKS; ++c) {
        radiance[c] = weight > 0.0f ? weight * radiance[c] : (float16)(0.0f);
        light[c] =
            lit ? emission(light_spectrum, context->colour, light_is_image, context->phases, c)
                : (float16)(0.0f);
    }
    const WalkReader reader = {chunks, walk.chunk, walk.count};
    replay_walk(context, reader, walk.reference, lit, light, radiance);
}
#endif

__kernel void gather(__global float* radiance_out, __global const PathState* paths,
                     __global const VertexRecord* vertices, __global const RayRecord* shadow_rays,
                     __global const float* lobe_weights, __global const float* colours,
                     __global const MaterialRecord* materials, __global const LayerRecord* layers,
                     __global const LobeRecord* lobes, __global const LightRecord* lights,
                     __global const float* tables, __global const WalkPartRecord* walk_parts,
                     __global const WalkChunk* walk_chunks,
                     __global const WalkVertexRecord* walk_vertices, uint image_light,
                     uint path_count, uint capacity, uint phases) {
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
        context.colour = colours;
#if FEATURE_COLOURS
        context.colour += slot * VERTEX_COLOURS;
#endif
        if (vertex.material == NO_INDEX) {
            __global const float* spectrum =
                tables + lights[vertex.emitter].spectrum + state.phase * LANES;
            for (uint c = 0u; c < CHUNKS; ++c)
                radiance[c] = vertex.emitted * emission(spectrum, context.colour,
                                                        vertex.emitter == image_light, phases, c);
            continue;
        }
        context.material = materials[vertex.material];
        context.layers = layers + context.material.first_layer;
        context.lobes = lobes + context.material.first_lobe;
        int lit = 0;
        __global const float* spectrum = tables;
#if FEATURE_LIGHT_SAMPLING
        lit = vertex.light != NO_INDEX && shadow_rays[slot].t_far >= 0.0f;
        if (lit)
            spectrum = tables + lights[vertex.light].spectrum + state.phase * LANES;
#endif
#if FEATURE_WALK
        if (context.material.walk != NO_INDEX) {
            context.walk_parts = walk_parts + context.material.walk;
            gather_walk(&context, &vertex, walk_vertices[slot], walk_chunks, lit, spectrum,
                        vertex.light == image_light, radiance);
            continue;
        }
#endif
        gather_vertex(&context, &vertex, lit, spectrum, vertex.light == image_light,
                      lobe_weights + slot * (2u * LOBES), radiance);
    }
    for (uint c = 0u; c < CHUNKS; ++c)
        vstore16(radiance[c], c, radiance_out + (size_t)path * LANES);
}
