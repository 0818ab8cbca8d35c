// A step at a material whose model is in closed form: one light and one direction are sampled, by
// scalars alone; wavelengths come in `gather`.
#ifndef RERADIANT_SHADE_LAYERS_H
#define RERADIANT_SHADE_LAYERS_H

#include "kernels/stack/layer_stack.h"
#include "kernels/stages/roulette.h"
#include "kernels/stages/shade_lights.h"
#include "kernels/stages/shade_surface.h"

LayerStackView layer_stack_of(const ShadeScene* scene, uint material) {
    LayerStackView stack;
    stack.record = scene->materials[material];
    stack.layers = scene->layers + stack.record.first_layer;
    stack.lobes = scene->lobes + stack.record.first_lobe;
    stack.tables = scene->tables;
    return stack;
}

#if FEATURE_SHEETS
/// The scalar weights of what goes through a sheet from a direction on its far side.
static DirectionRecord through_weights(LayerStackView stack, Vec3 wi, Vec3 wo, real scale,
                                       __global float* lobe_weights) {
    DirectionRecord d = {wi.x, wi.y, wi.z, scale, 0.0f, scale, 0.0f, 0.0f};
    if (stack.record.through_ratio != NO_INDEX)
        d.top = scale * layer_stack_through_lobe(stack, wi, wo);
#if FEATURE_DEEPER_LOBES
    for (uint l = 0u; l < stack.record.lobe_count; ++l)
        lobe_weights[l] = 0.0f;
#endif
    return d;
}
#endif

/// The scalar weights of all components in one direction; `scale` holds |cos| / pdf.
static DirectionRecord direction_weights(LayerStackView stack, Vec3 wi, Vec3 wo, real scale,
                                         __global float* lobe_weights) {
#if FEATURE_SHEETS
    if (wi.z < 0.0f)
        return through_weights(stack, wi, wo, scale, lobe_weights);
#endif
    DirectionRecord d = {wi.x, wi.y, wi.z, 0.0f, 0.0f, scale, 0.0f, 0.0f};
    const LayerDiffuse factors = layer_stack_diffuse(stack, wi, wo);
    d.diffuse = scale * factors.diffuse;
    d.first = scale * factors.first;
#if FEATURE_ROUGH
    if (stack.record.has_top_lobe)
        d.top = scale * layer_stack_top(stack, wi, wo);
#endif
#if FEATURE_DEEPER_LOBES
    for (uint l = 0u; l < stack.record.lobe_count; ++l)
        lobe_weights[l] = scale * layer_stack_deeper(stack, l, wi, wo);
#endif
    return d;
}

#if FEATURE_LIGHT_SAMPLING
/// Samples one light; the vertex gets its weights and the step its shadow ray.
static void connect_layers(const ShadeScene* scene, SurfacePoint point, LayerStackView stack,
                           const LayerChoice* choice, Random4 u, ShadeStep* step) {
    Vec3 wi;
    const LightSample sample = look_for_light(scene, point, u, &wi, step);
    if (!(sample.weight > 0.0f))
        return;
    const real selection = scene->lights[step->vertex.light].selection;
    real scale = fabs(wi.z) * sample.weight / selection;
    if (sample.pdf > 0.0f)
        scale *=
            lights_mis_weight(selection * sample.pdf, layer_stack_pdf(stack, choice, point.wo, wi));
    step->vertex.towards_light =
        direction_weights(stack, wi, point.wo, scale, step->lobe_weights + LOBES);
}
#endif

/// The weights of the mirror direction, or of straight on; nothing of the other components goes
/// there.
static DirectionRecord delta_weights(LayerStackView stack, Vec3 wi, real probability,
                                     __global float* lobe_weights) {
    DirectionRecord mirror = {wi.x, wi.y, wi.z, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    mirror.delta = 1.0f / probability;
#if FEATURE_DEEPER_LOBES
    for (uint l = 0u; l < stack.record.lobe_count; ++l)
        lobe_weights[l] = 0.0f;
#endif
    return mirror;
}

/// Probability of the delta that wi is the direction of.
static real delta_probability(const LayerChoice* choice, Vec3 wi) {
#if FEATURE_SHEETS
    if (wi.z < 0.0f)
        return layer_stack_probability(choice, CHOICE_STRAIGHT);
#endif
    return choice->cumulative[CHOICE_DELTA];
}

/// Notes how a path leaves a surface. Straight on through a sheet that shadow rays pass it goes on
/// as if there were none: lights behind it are found from the last vertex before in two ways.
static void leave_in(MaterialRecord material, Vec3 wi, real pdf, ShadeStep* step) {
#if FEATURE_PASSED_SHEETS
    if (material.is_passed && pdf < 0.0f && wi.z < 0.0f && step->state.crossings < MOST_CROSSINGS) {
        step->state.passed += step->hit.distance;
        ++step->state.crossings;
        return;
    }
    step->state.passed = 0.0f;
    step->state.crossings = 0u;
#endif
    step->state.bsdf_pdf = pdf;
}

/// Samples the direction in which the path goes on. It ends where none leaves the surface.
static void leave_layers(SurfacePoint point, LayerStackView stack, const LayerChoice* choice,
                         Random4 u, real survival, ShadeStep* step) {
    int is_delta;
    const Vec3 wi = layer_stack_sample(stack, choice, point.wo, u.a, u.b, u.c, &is_delta);
    const Vec3 direction = sampling_to_world(point.frame, wi);
    if (!surface_is_left(point, wi, direction))
        return;
    const real pdf = is_delta ? -1.0f : layer_stack_pdf(stack, choice, point.wo, wi);
    leave_in(stack.record, wi, pdf, step);
    if (is_delta)
        step->vertex.next =
            delta_weights(stack, wi, delta_probability(choice, wi) * survival, step->lobe_weights);
    else if (pdf > 0.0f)
        step->vertex.next = direction_weights(stack, wi, point.wo, fabs(wi.z) / (pdf * survival),
                                              step->lobe_weights);
    else
        return;
    step->vertex.has_next = 1u;
    step->next = ray_from(step->hit, direction, INFINITY);
}

/// u_light: chooses light and direction; u: direction and survival.
static void shade_layers(const ShadeScene* scene, SurfacePoint point, Random4 u_light, Random4 u,
                         ShadeStep* step) {
    const LayerStackView stack = layer_stack_of(scene, point.material);
    const LayerChoice choice = layer_stack_choice(stack, point.wo.z);
#if FEATURE_LIGHT_SAMPLING
    if (scene->render.sampled_lights > 0u)
        connect_layers(scene, point, stack, &choice, u_light, step);
#endif
    step->state.throughput *= choice.largest_albedo;
    const real survival =
        path_survival(step->state.throughput, step->depth, scene->render.min_depth);
    if (u.d < survival) {
        leave_layers(point, stack, &choice, u, survival, step);
        step->state.throughput /= survival;
    }
}

#endif
