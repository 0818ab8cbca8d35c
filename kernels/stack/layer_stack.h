// Scalar side of a layered material: which component to sample, with what pdf, and the scalar
// weights of its components. What depends on wavelength is applied in `gather` from tables.
//
// Components: mirror delta, rough top lobe, deeper rough lobes, and a cosine lobe that serves the
// diffuse part, the residual of the specular part (reradiant/stack_model.h) and what slabs
// scatter. Of a sheet also, on its far side: straight on, a rough lobe about that, a cosine lobe.
#ifndef RERADIANT_LAYER_STACK_H
#define RERADIANT_LAYER_STACK_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/sampling.h"
#include "kernels/core/shared.h"
#include "kernels/scatter/facet_shape.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/lobe_ratio.h"
#include "kernels/scatter/lobe_width.h"
#include "kernels/scatter/microfacet.h"
#include "kernels/scatter/oren_nayar.h"
#include "kernels/scatter/oren_nayar_shape.h"
#include "kernels/stack/model_a.h"

KERNELS_BEGIN

#if FEATURE_SHEETS
#define CHOICES (6 + LOBES)
#else
#define CHOICES (3 + LOBES)
#endif
#define CHOICE_DELTA 0
#define CHOICE_TOP 1
#define CHOICE_LOBE 2
#define CHOICE_DIFFUSE (2 + LOBES)
#define CHOICE_STRAIGHT (3 + LOBES)
#define CHOICE_THROUGH_LOBE (4 + LOBES)
#define CHOICE_THROUGH (5 + LOBES)

/// Cumulative probabilities of the components at one angle, and the albedo there of the lane that
/// reflects most, which Russian roulette uses.
typedef struct {
    real cumulative[CHOICES];
    real largest_albedo;
} LayerChoice;

/// A `LayerStackView` holds what shading needs of a material.
typedef struct {
    MaterialRecord record;
    GLOBAL_CONST LayerRecord* layers;
    GLOBAL_CONST LobeRecord* lobes;
    GLOBAL_CONST shared_float* tables; ///< of all materials
} LayerStackView;

DEVICE_FUNCTION LayerChoice layer_stack_choice(LayerStackView stack, real cos_o) {
    const real position = sqrt(fmin(fmax(cos_o, REAL(0.0)), REAL(1.0))) * (real)(TABLE_NODES - 1);
    uint node = (uint)position;
    node = node > TABLE_NODES - 2u ? TABLE_NODES - 2u : node;
    const real t = position - (real)node;
    GLOBAL_CONST shared_float* row = stack.tables + stack.record.choice + node * (CHOICES + 1u);
    LayerChoice choice;
    for (uint i = 0u; i < CHOICES; ++i)
        choice.cumulative[i] = row[i] + t * (row[i + CHOICES + 1u] - row[i]);
    choice.largest_albedo = row[CHOICES] + t * (row[2u * CHOICES + 1u] - row[CHOICES]);
    return choice;
}

DEVICE_FUNCTION real layer_stack_probability(const LayerChoice* choice, uint component) {
    return component == 0u ? choice->cumulative[0]
                           : choice->cumulative[component] - choice->cumulative[component - 1u];
}

#if FEATURE_DEEPER_LOBES
/// Width of a further lobe between two directions in air: its own, or under adding that of a deeper
/// interface seen through the rough ones above it.
DEVICE_FUNCTION real layer_stack_lobe_width(LayerStackView stack, LobeRecord lobe, real cos_i,
                                            real cos_o) {
    const real sin2_i = (REAL(1.0) - cos_i) * (REAL(1.0) + cos_i);
    const real sin2_o = (REAL(1.0) - cos_o) * (REAL(1.0) + cos_o);
    const int distribution = (int)lobe.distribution;
    real ior = REAL(1.0), terms = REAL(0.0);
    if (stack.record.weidlich_wilkie || lobe.shape != NO_INDEX)
        return lobe.alpha;
    for (uint l = 0u; l < lobe.layer; ++l) {
        const LayerRecord above = stack.layers[l];
        const real below = ior * above.eta;
        if (above.alpha > 0.0f)
            terms +=
                lobe_width_term(distribution, lobe_width_passage(above.alpha, ior, below, sin2_i)) +
                lobe_width_term(distribution, lobe_width_passage(above.alpha, ior, below, sin2_o));
        ior = below;
    }
    terms += lobe_width_term(distribution, lobe.alpha * (lobe_width_normal(ior, sin2_i) +
                                                         lobe_width_normal(ior, sin2_o)));
    return lobe_width(distribution, terms, cos_i, cos_o);
}
#endif

DEVICE_FUNCTION real layer_stack_lobe_pdf(int distribution, real alpha, Vec3 wo, Vec3 wi) {
    const Vec3 h = vec3_normalise(vec3_add(wo, wi));
    return microfacet_pdf(distribution, alpha, wo, h) /
           fmax(REAL(4.0) * vec3_dot(wo, h), REAL(1e-20));
}

#if FEATURE_SHEETS
/// A direction on the far side as its mirror image on this one.
DEVICE_FUNCTION Vec3 layer_stack_mirrored(Vec3 w) {
    return vec3(w.x, w.y, fabs(w.z));
}

/// Width of the lobe through a sheet's rough faces, each of which light passes once: half a passage
/// for either direction.
DEVICE_FUNCTION real layer_stack_through_width(LayerStackView stack, real cos_i, real cos_o) {
    const real sin2_i = (REAL(1.0) - cos_i) * (REAL(1.0) + cos_i);
    const real sin2_o = (REAL(1.0) - cos_o) * (REAL(1.0) + cos_o);
    real ior = REAL(1.0), terms = REAL(0.0);
    for (uint l = 0u; l < stack.record.layer_count; ++l) {
        const LayerRecord face = stack.layers[l];
        const real below = ior * face.eta;
        if (face.alpha > 0.0f)
            terms +=
                REAL(0.5) * (lobe_width_term(MICROFACET_GGX,
                                             lobe_width_passage(face.alpha, ior, below, sin2_i)) +
                             lobe_width_term(MICROFACET_GGX,
                                             lobe_width_passage(face.alpha, ior, below, sin2_o)));
        ior = below;
    }
    return lobe_width(MICROFACET_GGX, terms, cos_i, cos_o);
}

/// Ratio of that lobe to its facets, for a direction on this side and the mirror image of one on
/// the far side.
DEVICE_FUNCTION real layer_stack_through_ratio(LayerStackView stack, Vec3 own, Vec3 far) {
    GLOBAL_CONST shared_float* table = stack.tables + stack.record.through_ratio;
    const Vec3 first = stack.record.through_first ? own : far;
    const Vec3 second = stack.record.through_first ? far : own;
    return lobe_ratio_value(table, stack.record.through_width, first, second);
}

/// Scalar value of the lobe through rough faces, to be multiplied by its two amplitudes; `wi` lies
/// on the far side.
DEVICE_FUNCTION real layer_stack_through_lobe(LayerStackView stack, Vec3 wi, Vec3 wo) {
    const Vec3 mirrored = layer_stack_mirrored(wi);
    const real width = layer_stack_through_width(stack, mirrored.z, wo.z);
    return microfacet_reflection(MICROFACET_GGX, width, mirrored, wo) *
           layer_stack_through_ratio(stack, wo, mirrored);
}

/// Pdf of a direction on the far side.
DEVICE_FUNCTION real layer_stack_through_pdf(LayerStackView stack, const LayerChoice* choice,
                                             Vec3 wo, Vec3 wi) {
    const Vec3 mirrored = layer_stack_mirrored(wi);
    real pdf = layer_stack_probability(choice, CHOICE_THROUGH) * mirrored.z * INV_PI_REAL;
    if (stack.record.through_ratio != NO_INDEX)
        pdf += layer_stack_probability(choice, CHOICE_THROUGH_LOBE) *
               layer_stack_lobe_pdf(MICROFACET_GGX, layer_stack_through_width(stack, wo.z, wo.z),
                                    wo, mirrored);
    return pdf;
}
#endif

/// Pdf per solid angle with which `layer_stack_sample` picks wi by one of the components that are
/// not deltas. wo lies above the surface, wi too unless this is a sheet.
DEVICE_FUNCTION real layer_stack_pdf(LayerStackView stack, const LayerChoice* choice, Vec3 wo,
                                     Vec3 wi) {
#if FEATURE_SHEETS
    if (wi.z < REAL(0.0))
        return layer_stack_through_pdf(stack, choice, wo, wi);
#endif
    real pdf = layer_stack_probability(choice, CHOICE_DIFFUSE) * wi.z * INV_PI_REAL;
#if FEATURE_ROUGH
    if (stack.record.has_top_lobe) {
        const LayerRecord top = stack.layers[0];
        pdf += layer_stack_probability(choice, CHOICE_TOP) *
               layer_stack_lobe_pdf((int)top.distribution, top.alpha, wo, wi);
    }
#endif
#if FEATURE_DEEPER_LOBES
    for (uint l = 0u; l < stack.record.lobe_count; ++l)
        if (stack.lobes[l].slab == NO_INDEX && stack.lobes[l].shape == NO_INDEX)
            pdf += layer_stack_probability(choice, CHOICE_LOBE + l) *
                   layer_stack_lobe_pdf((int)stack.lobes[l].distribution,
                                        layer_stack_lobe_width(stack, stack.lobes[l], wo.z, wo.z),
                                        wo, wi);
#endif
    return pdf;
}

#if FEATURE_ROUGH || FEATURE_DEEPER_LOBES || FEATURE_SHEETS
DEVICE_FUNCTION Vec3 layer_stack_sample_lobe(int distribution, real alpha, Vec3 wo, real u1,
                                             real u2) {
    const Vec3 h = microfacet_sample(distribution, alpha, wo, u1, u2);
    return vec3_sub(vec3_scale(h, REAL(2.0) * vec3_dot(wo, h)), wo);
}
#endif

#if FEATURE_SHEETS
/// Direction of a component on the far side.
DEVICE_FUNCTION Vec3 layer_stack_sample_through(LayerStackView stack, const LayerChoice* choice,
                                                Vec3 wo, real u0, real u1, real u2, int* is_delta) {
    if (u0 < choice->cumulative[CHOICE_STRAIGHT]) {
        *is_delta = 1;
        return vec3_scale(wo, REAL(-1.0));
    }
    Vec3 wi = sampling_cosine(u1, u2);
    if (u0 < choice->cumulative[CHOICE_THROUGH_LOBE])
        wi = layer_stack_sample_lobe(MICROFACET_GGX, layer_stack_through_width(stack, wo.z, wo.z),
                                     wo, u1, u2);
    return vec3(wi.x, wi.y, -fmax(wi.z, REAL(0.0)));
}
#endif

/// Direction of a component that reflects. The result may lie below the surface.
DEVICE_FUNCTION Vec3 layer_stack_sample_reflected(LayerStackView stack, const LayerChoice* choice,
                                                  Vec3 wo, real u0, real u1, real u2,
                                                  int* is_delta) {
    *is_delta = 0;
#if FEATURE_SMOOTH
    if (u0 < choice->cumulative[CHOICE_DELTA]) {
        *is_delta = 1;
        return vec3(-wo.x, -wo.y, wo.z);
    }
#endif
#if FEATURE_ROUGH
    if (u0 < choice->cumulative[CHOICE_TOP])
        return layer_stack_sample_lobe((int)stack.layers[0].distribution, stack.layers[0].alpha, wo,
                                       u1, u2);
#endif
#if FEATURE_DEEPER_LOBES
    for (uint l = 0u; l < stack.record.lobe_count; ++l)
        if (u0 < choice->cumulative[CHOICE_LOBE + l])
            return layer_stack_sample_lobe(
                (int)stack.lobes[l].distribution,
                layer_stack_lobe_width(stack, stack.lobes[l], wo.z, wo.z), wo, u1, u2);
#endif
    return sampling_cosine(u1, u2);
}

/// Direction of one component, chosen by u0; *is_delta says whether it is the mirror, or straight
/// on. The result may lie below the surface, or in that of a sheet (z = 0): then the path ends.
DEVICE_FUNCTION Vec3 layer_stack_sample(LayerStackView stack, const LayerChoice* choice, Vec3 wo,
                                        real u0, real u1, real u2, int* is_delta) {
#if FEATURE_SHEETS
    if (stack.record.other_side != NO_INDEX) {
        *is_delta = 0;
        if (!(u0 < choice->cumulative[CHOICE_DIFFUSE]))
            return layer_stack_sample_through(stack, choice, wo, u0, u1, u2, is_delta);
        const Vec3 wi = layer_stack_sample_reflected(stack, choice, wo, u0, u1, u2, is_delta);
        return vec3(wi.x, wi.y, fmax(wi.z, REAL(0.0)));
    }
#endif
    return layer_stack_sample_reflected(stack, choice, wo, u0, u1, u2, is_delta);
}

#if FEATURE_DEEPER_LOBES
/// Light between the facets of the top interface: a ggx lobe times a tabulated ratio.
DEVICE_FUNCTION real layer_stack_facets(LayerStackView stack, LobeRecord lobe, Vec3 wi, Vec3 wo) {
    return microfacet_reflection(MICROFACET_GGX, lobe.alpha, wi, wo) *
           facet_shape_value(stack.tables + lobe.shape, lobe.alpha, wi, wo);
}
#endif

/// Ratio of a deeper interface's lobe to its facets, where it has a table.
#if FEATURE_DEEPER_LOBES
DEVICE_FUNCTION real layer_stack_lobe_ratio(LayerStackView stack, LobeRecord lobe, Vec3 wi,
                                            Vec3 wo) {
    if (lobe.ratio == NO_INDEX)
        return REAL(1.0);
    GLOBAL_CONST shared_float* table = stack.tables + lobe.ratio;
    return lobe_ratio_value(table, lobe.ratio_width, wi, wo) +
           lobe_ratio_value(table, lobe.ratio_width, wo, wi);
}
#endif

/// Scalar value of a further lobe, to be multiplied by its two amplitudes (and by what model A
/// evaluates per lane). 1/sr, no cosine.
#if FEATURE_DEEPER_LOBES
DEVICE_FUNCTION real layer_stack_deeper(LayerStackView stack, uint lobe, Vec3 wi, Vec3 wo) {
#if FEATURE_WEIDLICH_WILKIE
    if (stack.record.weidlich_wilkie == MODEL_A_PER_LANE)
        return REAL(1.0);
    if (stack.record.weidlich_wilkie == MODEL_A)
        return model_a_nested_lobe(stack.layers, stack.lobes[lobe], 0,
                                   model_a_facet(stack.layers, stack.lobes[lobe].layer, 0, wi, wo));
#endif
    const LobeRecord record = stack.lobes[lobe];
    if (record.shape != NO_INDEX)
        return layer_stack_facets(stack, record, wi, wo);
    return layer_stack_lobe_ratio(stack, record, wi, wo) *
           microfacet_reflection((int)record.distribution,
                                 layer_stack_lobe_width(stack, record, wi.z, wo.z), wi, wo);
}
#endif

/// Scalar value of the rough top lobe, Fresnel included unless it depends on wavelength.
#if FEATURE_ROUGH
DEVICE_FUNCTION real layer_stack_top(LayerStackView stack, Vec3 wi, Vec3 wo) {
    const LayerRecord top = stack.layers[0];
    const real lobe = microfacet_reflection((int)top.distribution, top.alpha, wi, wo);
    if (top.eta_lanes != NO_INDEX || top.reflectance != NO_INDEX)
        return lobe;
    const Vec3 h = vec3_normalise(vec3_add(wi, wo));
    return lobe * fresnel_dielectric(fmax(vec3_dot(wi, h), REAL(0.0)), top.eta);
}
#endif

/// Scalar factors of the diffuse part: of its operator, and of that for light that met an
/// Oren-Nayar substrate once.
typedef struct {
    real diffuse, first;
} LayerDiffuse;

#if FEATURE_OREN_NAYAR
/// pi f / rho of the substrate for two directions in air, refracted down to it (by the IOR at the
/// reference wavelength) or spread on their way.
DEVICE_FUNCTION real layer_stack_oren_nayar_value(LayerStackView stack, Vec3 wi, Vec3 wo) {
    const MaterialRecord record = stack.record;
#if FEATURE_ROUGH || FEATURE_DEEPER_LOBES || FEATURE_SCATTERING_SLABS
    if (record.spread_value != NO_INDEX)
        return oren_nayar_spread_value(stack.tables + record.spread_value, wi, wo);
#endif
    return PI_REAL * oren_nayar_value(record.sigma, fresnel_refracted(wi, record.lowest_ior),
                                      fresnel_refracted(wo, record.lowest_ior));
}

/// Returns the weights of the diffuse part: where its first bounce stands apart, the weights `rest`
/// and `first` of host/layers/models/oren_nayar_substrate.h; else pi f / rho.
DEVICE_FUNCTION LayerDiffuse layer_stack_oren_nayar(LayerStackView stack, Vec3 wi, Vec3 wo) {
    const MaterialRecord record = stack.record;
    LayerDiffuse weights;
    weights.first = REAL(0.0);
    weights.diffuse = layer_stack_oren_nayar_value(stack, wi, wo);
    if (record.first_diagonal != NO_INDEX) {
        GLOBAL_CONST shared_float* albedo = stack.tables + record.separable_albedo;
        const real mean = oren_nayar_mean_albedo(record.sigma);
        const real product =
            oren_nayar_separable_albedo(albedo, wi.z) * oren_nayar_separable_albedo(albedo, wo.z);
        weights.first = weights.diffuse - product / mean;
        weights.diffuse = product / square(mean);
    }
    return weights;
}
#endif

/// Returns the factors of the diffuse part: 1, or model A's interfaces (without absorption) where
/// they do not depend on wavelength, and Oren-Nayar's shape.
DEVICE_FUNCTION LayerDiffuse layer_stack_diffuse(LayerStackView stack, Vec3 wi, Vec3 wo) {
    LayerDiffuse factor;
    factor.diffuse = REAL(1.0);
    factor.first = REAL(0.0);
#if FEATURE_OREN_NAYAR
    if (stack.record.sigma > 0.0f)
        factor = layer_stack_oren_nayar(stack, wi, wo);
#endif
#if FEATURE_WEIDLICH_WILKIE
    if (stack.record.weidlich_wilkie == MODEL_A) {
        const LayerDescent descent =
            model_a_descend(stack.layers, stack.record.layer_count, 0, wi, wo);
        factor.diffuse *= descent.way_in * descent.way_out;
    }
#endif
    return factor;
}

KERNELS_END

#endif
