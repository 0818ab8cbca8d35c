// Stage 5: radiance of each path, from its last vertex back to the camera. At every vertex one
// linear operator acts on a vector of wavelengths: L = T(o) B (T(i) L_in) + specular, where B
// holds the substrate with all its interreflections (DESIGN 2 B, 3).
#include "kernels/features.h"
#include "kernels/fresnel.h"
#include "kernels/layer_stack.h"
#include "kernels/portable.h"
#include "kernels/random.h"
#include "kernels/shared.h"
#include "kernels/table.h"
#if FEATURE_WALK
#include "kernels/walk_events.h"
#endif

// A path's wavelengths: the few of its hero set at each vertex, or all lanes in vectors of 16.
#if FEATURE_HERO
#include "kernels/hero.h"
#define PATH_CHUNKS 1
#define PATH_WIDTH HERO_WIDTH
#else
#include "kernels/reradiation.h"
typedef float16 Lanes;
#define PATH_CHUNKS CHUNKS
#define PATH_WIDTH WIDTH
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
#if FEATURE_HERO
    HeroLanes lanes;    ///< that are looked up
    HeroLanes incoming; ///< of the radiance that comes to the vertex
    HeroLanes leaving;  ///< towards the camera
    Lanes weights;      ///< of `incoming`, hero.h
#endif
} GatherContext;

/// Values of a row [lane] for one vector of a path.
Lanes path_row(const GatherContext* context, __global const float* row, uint chunk) {
#if FEATURE_HERO
    return hero_row(context->lanes, row);
#else
    return vload16(chunk, row);
#endif
}

#if FEATURE_DISPERSION
/// Lane at a place among all of a path's.
uint path_lane(const GatherContext* context, uint place) {
#if FEATURE_HERO
    return hero_lane(context->lanes, place);
#else
    return place;
#endif
}
#endif

float grey_lookup(__global const float* table, TableStencil s) {
    return s.w0 * table[s.node] + s.w1 * table[s.node + 1u] + s.w2 * table[s.node + 2u] +
           s.w3 * table[s.node + 3u];
}

/// Value of a table by lanes, [phase][node][lane], for one vector of them.
Lanes spectral_lookup(const GatherContext* context, uint offset, TableStencil s, uint chunk) {
    __global const float* rows =
        context->tables + offset + ((size_t)context->phase * TABLE_NODES + s.node) * LANES;
    return s.w0 * path_row(context, rows, chunk) + s.w1 * path_row(context, rows + LANES, chunk) +
           s.w2 * path_row(context, rows + 2 * LANES, chunk) +
           s.w3 * path_row(context, rows + 3 * LANES, chunk);
}

/// Table value for one vector of lanes: the same number for a grey stack.
Lanes stack_lookup(const GatherContext* context, uint offset, TableStencil s, uint chunk) {
#if FEATURE_SPECTRAL_STACK
    if (context->material.spectral)
        return spectral_lookup(context, offset, s, chunk);
#endif
    return (Lanes)(grey_lookup(context->tables + offset, s));
}

#if FEATURE_DISPERSION
/// Fresnel reflectance per lane; lanes are done one by one, dispersive tops are rare.
Lanes fresnel_lanes(const GatherContext* context, __global const float* eta, float cos_h,
                    uint chunk) {
    Lanes result;
    for (uint i = 0u; i < PATH_WIDTH; ++i)
        ((float*)&result)[i] =
            fresnel_dielectric(cos_h, eta[path_lane(context, chunk * PATH_WIDTH + i)]);
    return result;
}
#endif

#if FEATURE_TABULATED_REFLECTANCE
/// Reflectance of a part's facets for one vector of lanes, tabulated over the cosine at the facet.
Lanes facet_reflectance(const GatherContext* context, uint offset, float cos_h, uint chunk) {
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
void model_a_ways(const GatherContext* context, Vec3 wi, Vec3 wo, Lanes* way_in, Lanes* way_out) {
    for (uint i = 0u; i < PATH_CHUNKS * PATH_WIDTH; ++i) {
        const LayerDescent descent =
            layer_stack_descend(context->layers, context->material.layer_count,
                                lane_etas(context, path_lane(context, i)), wi, wo);
        ((float*)way_in)[i] = descent.way_in;
        ((float*)way_out)[i] = descent.way_out;
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

/// A deeper lobe of model A for one vector of lanes.
Lanes model_a_lobe(const GatherContext* context, LobeRecord lobe, Vec3 wi, Vec3 wo, uint chunk) {
    Lanes result;
    for (uint i = 0u; i < PATH_WIDTH; ++i) {
        const uint lane = path_lane(context, chunk * PATH_WIDTH + i);
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
Lanes top_reflectance(const GatherContext* context, Vec3 wi, Vec3 wo, uint chunk) {
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
        return fresnel_lanes(context,
                             context->tables + top.eta_lanes + (size_t)context->phase * LANES,
                             cos_h, chunk);
#endif
#endif
    return (Lanes)(1.0f);
}
#endif

#if FEATURE_DEEPER_LOBES && FEATURE_WEIDLICH_WILKIE &&                                             \
    (FEATURE_SCATTERING_SLABS || FEATURE_TABULATED_REFLECTANCE)
#define FEATURE_MODEL_A_TABULATED 1

/// What the tables add to a deeper lobe of model A for one vector of lanes.
Lanes model_a_tabulated(const GatherContext* context, LobeRecord lobe, Vec3 wi, Vec3 wo,
                        uint chunk) {
    const LayerFacet facet = layer_stack_facet(context->layers, lobe.layer, 0, wi, wo);
#if FEATURE_SCATTERING_SLABS
    if (lobe.slab != NO_INDEX) {
        __global const float* slab = context->tables + lobe.slab + context->phase * LANES;
        const Lanes depth = path_row(context, slab, chunk);
        const Lanes albedo = path_row(context, slab + (size_t)context->phases * LANES, chunk);
        return -albedo * expm1(-depth * (1.0f / facet.wi.z + 1.0f / facet.wo.z));
    }
#endif
#if FEATURE_TABULATED_REFLECTANCE
    if (context->layers[lobe.layer].reflectance != NO_INDEX)
        return facet_reflectance(context, context->layers[lobe.layer].reflectance, facet.cos_h,
                                 chunk);
#endif
    return (Lanes)(1.0f);
}
#else
#define FEATURE_MODEL_A_TABULATED 0
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

/// Adds what one direction brings to the substrate (`down`; `first`: what meets it once, see
/// oren-nayar) and to the specular part (`up`).
void gather_direction(const GatherContext* context, DirectionRecord d, Vec3 wo, TableStencil so,
                      __global const float* lobe_weights, const Lanes* radiance, Lanes* down,
                      Lanes* first, Lanes* up) {
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
/// What model A sends out towards wo of one direction's light on the substrate: the way in acts at
/// the excitation wavelength, the way out at that of emission, so directions do not mix.
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

/// Radiance of a light along the way it was seen, for one vector; spectrum: at the path's phase.
Lanes emission(const GatherContext* context, __global const float* spectrum, uint is_image,
               uint chunk) {
#if FEATURE_ENVIRONMENT_IMAGE
    if (is_image) {
        const size_t size = (size_t)context->phases * LANES;
        return context->colour[0] * path_row(context, spectrum, chunk) +
               context->colour[1] * path_row(context, spectrum + size, chunk) +
               context->colour[2] * path_row(context, spectrum + 2u * size, chunk);
    }
#endif
    return path_row(context, spectrum, chunk);
}

/// Radiance that leaves a vertex; `radiance` holds what comes along `next` and receives the sum.
void gather_vertex(const GatherContext* context, const VertexRecord* vertex, int lit,
                   __global const float* light_spectrum, uint light_is_image,
                   __global const float* vertex_lobes, Lanes* radiance) {
    Lanes down[PATH_CHUNKS], up[PATH_CHUNKS];
#if FEATURE_OREN_NAYAR
    Lanes first[PATH_CHUNKS];
#else
    Lanes* const first = down;
#endif
#if FEATURE_HERO
    Lanes left[PATH_CHUNKS] = {(Lanes)(0.0f)}; // `up` is at other wavelengths than what leaves
    radiance[0] *= context->weights;
#else
    Lanes* const left = up;
#endif
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        down[c] = (Lanes)(0.0f);
#if FEATURE_OREN_NAYAR
        first[c] = (Lanes)(0.0f);
#endif
        up[c] = (Lanes)(0.0f);
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
            leave_substrate_per_lane(context, vertex->next, wo, so, down, left);
#endif
    }
#if FEATURE_LIGHT_SAMPLING
    if (lit) {
        for (uint c = 0u; c < PATH_CHUNKS; ++c)
            radiance[c] = emission(context, light_spectrum, light_is_image, c);
#if FEATURE_HERO
        radiance[0] *= context->weights;
#endif
        gather_direction(context, vertex->towards_light, wo, so, vertex_lobes + LOBES, radiance,
                         down, first, up);
#if FEATURE_MODEL_A_PER_LANE
        if (per_lane)
            leave_substrate_per_lane(context, vertex->towards_light, wo, so, down, left);
#endif
    }
#endif
    leave_substrate(context, so, down, first, left);
#if FEATURE_HERO
    left[0] += context->material.shift == NO_INDEX
                   ? up[0]
                   : hero_unshifted(context->leaving, context->incoming, up[0]);
#endif
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance[c] = left[c];
}

#if FEATURE_WALK
/// exp(-(depth - sampled) length) of a slab for one vector of lanes, times its scattering where it
/// scattered.
Lanes walk_slab_lanes(const GatherContext* context, WalkPartRecord part, float sampled,
                      float length, int scattered, uint chunk) {
    const uint lanes = context->phase * LANES;
    const Lanes depth = path_row(context, context->tables + part.extinction + lanes, chunk);
    const Lanes passed = exp((sampled - depth) * length);
#if FEATURE_SCATTERING_SLABS
    if (scattered)
        return passed * path_row(context, context->tables + part.scattering + lanes, chunk) /
               sampled;
#endif
    return passed;
}

/// L = M L; the material's operator is M / pi.
void walk_substrate(const GatherContext* context, Lanes* radiance) {
    Lanes emitted[PATH_CHUNKS];
    substrate(context, radiance, radiance, emitted);
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance[c] = PI_REAL * emitted[c];
}

/// What one event takes from the lanes of `light` or of the path.
Lanes walk_event_lanes(const GatherContext* context, WalkEvent event, uint reference, uint chunk) {
    const uint kind = WALK_KIND(event.code);
    const WalkPartRecord part = context->walk_parts[WALK_INDEX(event.code)];
#if FEATURE_TABULATED_REFLECTANCE
    if (kind == WALK_REFLECT || kind == WALK_LIGHT_REFLECT)
        return facet_reflectance(context, part.reflectance, event.value, chunk);
    if (kind == WALK_BOUNCE || kind == WALK_LIGHT_BOUNCE)
        return path_row(context, context->tables + part.bounced + context->phase * LANES, chunk);
#endif
    const float sampled = kind == WALK_LIGHT_PASS ? 0.0f : part.references[reference];
    return walk_slab_lanes(context, part, sampled, event.value, kind == WALK_SCATTER, chunk);
}

/// Replays a walk from its last event to its first: `radiance` holds what comes in along the
/// path's next direction (weight included) and receives what leaves towards the camera; `light` is
/// the spectrum of the light that connections see.
void replay_walk(const GatherContext* context, WalkReader reader, uint reference, int lit,
                 const Lanes* light, Lanes* radiance) {
    Lanes seen[PATH_CHUNKS];
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        seen[c] = light[c];
    WalkEvent event;
    while (walk_read(&reader, &event)) {
        const uint kind = WALK_KIND(event.code);
        if (kind == WALK_SUBSTRATE) {
            walk_substrate(context, radiance);
            continue;
        }
        for (uint c = 0u; c < PATH_CHUNKS; ++c) {
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
                 uint light_is_image, Lanes* radiance) {
    Lanes light[PATH_CHUNKS];
    const float weight = vertex->has_next ? walk.weight : 0.0f;
    for (uint c = 0u; c < PATH_CHUNKS; ++c) {
        radiance[c] = weight > 0.0f ? weight * radiance[c] : (Lanes)(0.0f);
        light[c] = lit ? emission(context, light_spectrum, light_is_image, c) : (Lanes)(0.0f);
    }
    const WalkReader reader = {chunks, walk.chunk, walk.count};
    replay_walk(context, reader, walk.reference, lit, light, radiance);
}
#endif

#if FEATURE_HERO
/// Where the sets of one path are kept: [depth][path][HERO_WIDTH], those with which it comes to a
/// vertex from the camera, and the weights of their choice.
typedef struct {
    __global uint* lanes;
    __global float* weights;
    uint path, capacity;
} HeroSets;

/// Samples the wavelengths of a whole path, from the camera on.
void choose_lanes(HeroSets sets, PathState state, __global const VertexRecord* vertices,
                  __global const MaterialRecord* materials, __global const float* tables,
                  HeroLanes lanes, uint seed) {
    HERO_STORE(lanes, sets.path, sets.lanes);
    for (uint depth = 0u; depth < state.vertex_count; ++depth) {
        const size_t slot = (size_t)depth * sets.capacity + sets.path;
        const uint material = vertices[slot].material;
        Lanes weights = (Lanes)(1.0f);
        if (material != NO_INDEX && materials[material].shift != NO_INDEX)
            lanes = hero_shift(
                tables + materials[material].shift + (size_t)state.phase * (LANES * LANES), lanes,
                random_4(state.pixel, state.sample, HERO_DIMENSION + 1u + depth, seed).a, &weights);
        HERO_STORE(lanes, slot + sets.capacity, sets.lanes);
        HERO_STORE(weights, slot + sets.capacity, sets.weights);
    }
}

/// The wavelengths at a vertex; an emitter is looked up at those that arrive from the camera.
void set_lanes(GatherContext* context, HeroSets sets, uint depth, int is_emitter) {
    const size_t slot = (size_t)depth * sets.capacity + sets.path;
    context->leaving = HERO_LOAD(slot, sets.lanes);
    context->incoming = HERO_LOAD(slot + sets.capacity, sets.lanes);
    context->weights = HERO_LOAD(slot + sets.capacity, sets.weights);
    context->lanes = is_emitter ? context->leaving : context->incoming;
}

/// Adds the set's radiance to its lanes, all others are 0.
void store_hero(HeroLanes lanes, Lanes radiance, __global float* out) {
    for (uint c = 0u; c < CHUNKS; ++c)
        vstore16((float16)(0.0f), c, out);
    for (uint j = 0u; j < HERO; ++j)
        out[hero_lane(lanes, j)] += ((const float*)&radiance)[j];
}
#endif

__kernel void gather(__global float* radiance_out, __global const PathState* paths,
                     __global const VertexRecord* vertices, __global const RayRecord* shadow_rays,
                     __global const float* lobe_weights, __global const float* colours,
                     __global const MaterialRecord* materials, __global const LayerRecord* layers,
                     __global const LobeRecord* lobes, __global const LightRecord* lights,
                     __global const float* tables, __global const WalkPartRecord* walk_parts,
                     __global const WalkChunk* walk_chunks,
                     __global const WalkVertexRecord* walk_vertices, __global uint* hero_lanes,
                     __global float* hero_weights, uint hero_first, uint hero_count,
                     uint image_light, uint path_count, uint capacity, uint phases, uint seed) {
    const uint path = (uint)get_global_id(0);
    if (path >= path_count)
        return;
    const PathState state = paths[path];
    GatherContext context;
    context.tables = tables;
    context.phase = state.phase;
    context.phases = phases;
#if FEATURE_HERO
    const HeroSets sets = {hero_lanes, hero_weights, path, capacity};
    choose_lanes(sets, state, vertices, materials, tables,
                 hero_rotated(random_4(state.pixel, state.sample, HERO_DIMENSION, seed).a,
                              hero_first, hero_count),
                 seed);
#endif
    Lanes radiance[PATH_CHUNKS];
    for (uint c = 0u; c < PATH_CHUNKS; ++c)
        radiance[c] = (Lanes)(0.0f);
    for (uint depth = state.vertex_count; depth-- > 0u;) {
        const size_t slot = (size_t)depth * capacity + path;
        const VertexRecord vertex = vertices[slot];
#if FEATURE_HERO
        set_lanes(&context, sets, depth, vertex.material == NO_INDEX);
#endif
        context.colour = colours;
#if FEATURE_COLOURS
        context.colour += slot * VERTEX_COLOURS;
#endif
        if (vertex.material == NO_INDEX) {
            __global const float* spectrum =
                tables + lights[vertex.emitter].spectrum + state.phase * LANES;
            for (uint c = 0u; c < PATH_CHUNKS; ++c)
                radiance[c] =
                    vertex.emitted * emission(&context, spectrum, vertex.emitter == image_light, c);
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
    radiance_out += (size_t)path * LANES;
#if FEATURE_HERO
    store_hero(HERO_LOAD(path, hero_lanes), radiance[0] * ((float)hero_count / HERO), radiance_out);
#else
    for (uint c = 0u; c < CHUNKS; ++c)
        vstore16(radiance[c], c, radiance_out);
#endif
}
