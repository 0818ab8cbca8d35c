// A step at a material whose model is the random walk through its stack (walk.h).
#ifndef RERADIANT_SHADE_WALK_H
#define RERADIANT_SHADE_WALK_H

#include "kernels/stages/roulette.h"
#include "kernels/stages/shade_lights.h"
#include "kernels/stages/shade_surface.h"

#if FEATURE_WALK
#include "kernels/walk/walk.h"

/// Random dimensions of walks through stacks, far from all others; each vertex of a path has a
/// range of its own.
#define WALK_DIMENSION 0x80000000u
#define WALK_DIMENSIONS_PER_VERTEX 0x100000u

/// The walk of a step, before it begins.
Walk walk_of(const ShadeScene* scene, MaterialRecord material, const ShadeStep* step) {
    Walk walk;
    walk.stack.parts = scene->walk_parts + material.walk;
    walk.stack.tables = scene->tables;
    walk.stack.count = material.layer_count;
    walk.stack.sigma = material.sigma;
#if FEATURE_SHEETS
    walk.stack.is_sheet = material.other_side != NO_INDEX;
#else
    walk.stack.is_sheet = 0;
#endif
    walk.light_pdf = walk.light_cosine = 0.0f;
    walk.is_light_far = 0;
    walk.writer = walk_writer(scene->walk_chunks, scene->walk_chunks_used, scene->walk_room);
    walk.random =
        walk_random(step->state.pixel, step->state.sample,
                    WALK_DIMENSION + step->depth * WALK_DIMENSIONS_PER_VERTEX, scene->render.seed);
    return walk;
}

/// Walks, connected to one light where lights are sampled. u_light: chooses light and direction;
/// u: survival.
static void shade_walk(const ShadeScene* scene, SurfacePoint point, MaterialRecord material,
                       Random4 u_light, real u, ShadeStep* step) {
    Walk walk = walk_of(scene, material, step);
    WalkArrival arrivals[WALK_PLACES];
    walk_clear_arrivals(arrivals);
    walk.arrivals = arrivals;
#if FEATURE_LIGHT_SAMPLING
    if (scene->render.sampled_lights > 0u) {
        Vec3 wi;
        const LightSample sample = look_for_light(scene, point, u_light, &wi, step);
        if (sample.weight > 0.0f) {
            const real selection = scene->lights[step->vertex.light].selection;
            walk.light_pdf = selection * sample.pdf;
            walk.light_cosine = fabs(wi.z);
            walk.is_light_far = FEATURE_SHEETS && wi.z < 0.0f;
            walk_light(walk.stack, wi, sample.weight / selection, &walk.random, arrivals);
        }
    }
#endif
    const WalkEnd end = walk_stack(&walk, point.wo);
    const Vec3 direction = sampling_to_world(point.frame, end.direction);
    step->state.throughput *= end.expected;
    const real survival =
        path_survival(step->state.throughput, step->depth, scene->render.min_depth);
    if (end.weight > 0.0f && u < survival && surface_is_left(point, end.direction, direction)) {
        step->vertex.has_next = 1u;
        step->state.throughput /= survival;
        step->state.bsdf_pdf = end.pdf;
#if FEATURE_PASSED_SHEETS
        step->state.passed = 0.0f;
        step->state.crossings = 0u;
#endif
        step->next = ray_from(step->hit, direction, INFINITY);
    }
    const WalkVertexRecord kept = {walk.writer.chunk, walk.writer.count,
                                   walk.by_flight ? NO_INDEX : walk.reference,
                                   end.weight / survival};
    step->walk = kept;
}
#endif

#endif
