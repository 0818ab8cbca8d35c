// The wavelength sets of a path that samples them (hero.h): from the camera on, one set a vertex.
#ifndef RERADIANT_GATHER_HERO_H
#define RERADIANT_GATHER_HERO_H

#include "kernels/core/random.h"
#include "kernels/stages/gather_lanes.h"

#if FEATURE_HERO
/// A `HeroSets` says where the wavelength sets of one path are kept, in arrays
/// [depth][path][HERO_WIDTH]: `lanes` holds the sets with which the path comes to a vertex from the
/// camera, `weights` the weights of their choice.
typedef struct {
    __global uint* lanes;
    __global float* weights;
    uint path, capacity;
} HeroSets;

/// Samples the wavelengths of a whole path, from the camera on.
void choose_lanes(HeroSets sets, PathState state, const GatherScene* scene, RenderRecord render) {
    HeroLanes lanes =
        hero_rotated(random_4(state.pixel, state.sample, HERO_DIMENSION, render.seed).a,
                     render.first_seen_lane, render.seen_lanes);
    HERO_STORE(lanes, sets.path, sets.lanes);
    for (uint depth = 0u; depth < state.vertex_count; ++depth) {
        const size_t slot = (size_t)depth * sets.capacity + sets.path;
        const uint material = scene->vertices[slot].material;
        Lanes weights = (Lanes)(1.0f);
        if (material != NO_INDEX && scene->materials[material].shift != NO_INDEX)
            lanes = hero_shift(
                scene->tables + scene->materials[material].shift +
                    (size_t)state.phase * (LANES * LANES),
                lanes,
                random_4(state.pixel, state.sample, HERO_DIMENSION + 1u + depth, render.seed).a,
                &weights);
        HERO_STORE(lanes, slot + sets.capacity, sets.lanes);
        HERO_STORE(weights, slot + sets.capacity, sets.weights);
    }
}

/// The wavelengths at a vertex. An emitter is looked up at those that arrive from the camera.
void load_lanes(GatherContext* context, HeroSets sets, size_t slot) {
    context->leaving = HERO_LOAD(slot, sets.lanes);
    context->incoming = HERO_LOAD(slot + sets.capacity, sets.lanes);
    context->weights = HERO_LOAD(slot + sets.capacity, sets.weights);
}

/// Adds the set's radiance to its lanes, all others are 0.
void store_hero(HeroLanes lanes, Lanes radiance, __global float* out) {
    for (uint c = 0u; c < CHUNKS; ++c)
        vstore16((float16)(0.0f), c, out);
    for (uint j = 0u; j < HERO; ++j)
        out[hero_lane(lanes, j)] += ((const float*)&radiance)[j];
}
#endif

#endif
