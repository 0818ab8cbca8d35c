// Defines what `gather` knows of a vertex, and looks up its tables for vectors of a path's
// wavelengths.
#ifndef RERADIANT_GATHER_LANES_H
#define RERADIANT_GATHER_LANES_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/core/table.h"
#include "kernels/scatter/fresnel.h"

// A path's wavelengths: the few of its hero set at each vertex, or all lanes in vectors of 16.
#if FEATURE_HERO
#include "kernels/stack/hero.h"
#define PATH_CHUNKS 1
#define PATH_WIDTH HERO_WIDTH
#else
#include "kernels/stack/reradiation.h"
typedef float16 Lanes;
#define PATH_CHUNKS CHUNKS
#define PATH_WIDTH WIDTH
#endif

/// A `GatherScene` holds the arrays that `gather` reads, and the path's phase.
typedef struct {
    __global const VertexRecord* vertices;
    __global const RayRecord* shadow_rays;
    __global const SheetCrossing* crossings; ///< of shadow rays, MOST_CROSSINGS each
    __global const float* lobe_weights;
    __global const float* colours;
    __global const MaterialRecord* materials;
    __global const LayerRecord* layers;
    __global const LobeRecord* lobes;
    __global const LightRecord* lights;
    __global const float* tables;
    __global const WalkPartRecord* walk_parts;
    __global const WalkChunk* walk_chunks;
    __global const WalkVertexRecord* walk_vertices;
    uint image_light; ///< the environment that is an image, or NO_INDEX
    uint phase, phases;
} GatherScene;

/// A `GatherContext` is what is looked up at one vertex.
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

// Tables hold shares. Beside a kink, such as that where the residual ends, a cubic dips below zero
// and would take light away; comparing instead of fmax keeps a NaN.

float grey_lookup(__global const float* table, TableStencil s) {
    const float value = s.w0 * table[s.node] + s.w1 * table[s.node + 1u] +
                        s.w2 * table[s.node + 2u] + s.w3 * table[s.node + 3u];
    return value < 0.0f ? 0.0f : value;
}

/// Value of a table by lanes, [phase][node][lane], for one vector of them.
Lanes spectral_lookup(const GatherContext* context, uint offset, TableStencil s, uint chunk) {
    __global const float* rows =
        context->tables + offset + ((size_t)context->phase * TABLE_NODES + s.node) * LANES;
    const Lanes value = (float)s.w0 * path_row(context, rows, chunk) +
                        (float)s.w1 * path_row(context, rows + LANES, chunk) +
                        (float)s.w2 * path_row(context, rows + 2 * LANES, chunk) +
                        (float)s.w3 * path_row(context, rows + 3 * LANES, chunk);
    return value < 0.0f ? (Lanes)(0.0f) : value;
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

/// Radiance of a light along the way it was seen from a vertex, for one vector.
Lanes emission(const GatherScene* scene, const GatherContext* context, uint light, uint chunk) {
    __global const float* spectrum =
        scene->tables + scene->lights[light].spectrum + scene->phase * LANES;
#if FEATURE_ENVIRONMENT_IMAGE
    if (light == scene->image_light) {
        const size_t size = (size_t)scene->phases * LANES;
        return context->colour[0] * path_row(context, spectrum, chunk) +
               context->colour[1] * path_row(context, spectrum + size, chunk) +
               context->colour[2] * path_row(context, spectrum + 2u * size, chunk);
    }
#endif
    return path_row(context, spectrum, chunk);
}

/// Radiance of the light that a vertex looked for, as it comes through smooth sheets.
Lanes light_found(const GatherScene* scene, const GatherContext* context, uint light, size_t slot,
                  uint chunk) {
    Lanes radiance = emission(scene, context, light, chunk);
#if FEATURE_PASSED_SHEETS
    GatherContext sheet = *context;
    for (uint k = 0u; k < MOST_CROSSINGS; ++k) {
        const SheetCrossing crossing = scene->crossings[slot * MOST_CROSSINGS + k];
        if (crossing.material == NO_INDEX)
            break;
        sheet.material = scene->materials[crossing.material];
        radiance *= stack_lookup(&sheet, sheet.material.through_delta,
                                 table_stencil(crossing.cosine), chunk);
    }
#endif
    return radiance;
}

#endif
