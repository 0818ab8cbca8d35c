// Model A (Weidlich and Wilkie 2007): two directions on their way down a stack, refracted at the
// macroscopic normals, and what its parts let through and reflect between them. Both kinds of
// caller take their parts from the air down: the device from LayerRecords (model_a_descend), the
// host from its stacks, with their slabs and films (host/layers/models/weidlich_wilkie.cpp).
#ifndef RERADIANT_MODEL_A_H
#define RERADIANT_MODEL_A_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/henyey_greenstein.h"
#include "kernels/scatter/microfacet.h"

KERNELS_BEGIN

/// Two directions just above a part, and what the parts above let through: way_in = product of T12,
/// way_out = product of t, with what else a caller multiplies (model_a_pass). Both are 0 once one
/// of the directions was totally reflected.
typedef struct {
    Vec3 wi, wo;
    real way_in, way_out;
} LayerDescent;

DEVICE_FUNCTION LayerDescent model_a_start(Vec3 wi, Vec3 wo) {
    LayerDescent descent;
    descent.wi = wi;
    descent.wo = wo;
    descent.way_in = REAL(1.0);
    descent.way_out = REAL(1.0);
    return descent;
}

/// Lets shares of the light through each way.
DEVICE_FUNCTION void model_a_pass(LayerDescent* d, real share_in, real share_out) {
    d->way_in *= share_in;
    d->way_out *= share_out;
}

/// A `LayerMeeting` says how two directions meet an interface: their cosines there, and the share G
/// of its facets that see both.
typedef struct {
    real cos_i, cos_o, g;
} LayerMeeting;

/// At the half vector of a rough interface, or at the normal (alpha 0).
DEVICE_FUNCTION LayerMeeting model_a_meeting(int distribution, real alpha, Vec3 wi, Vec3 wo) {
    LayerMeeting meeting;
    meeting.cos_i = wi.z;
    meeting.cos_o = wo.z;
    meeting.g = REAL(1.0);
    if (alpha > REAL(0.0)) {
        const Vec3 h = vec3_normalise(vec3_add(wi, wo));
        meeting.cos_i = meeting.cos_o = fmax(vec3_dot(wi, h), REAL(0.0));
        meeting.g = microfacet_g2(distribution, alpha, wi, wo, h);
    }
    return meeting;
}

/// Crosses an interface of IOR ratio eta (below over above) that lets `through_i` and `through_o`
/// of the light pass at the two cosines of the meeting: T12 on the way in, t = (1 - G) + T21 G on
/// the way out (eqs. 3 to 5). T21 at a refracted direction is T12 at the one above.
DEVICE_FUNCTION void model_a_cross(LayerDescent* d, LayerMeeting meeting, real eta, real through_i,
                                   real through_o) {
    const real t = (REAL(1.0) - meeting.g) + through_o * meeting.g;
    int passes;
    d->wi = fresnel_refracted(d->wi, eta);
    d->wo = fresnel_refracted(d->wo, eta);
    passes = d->wi.z > REAL(0.0) && d->wo.z > REAL(0.0);
    d->way_in = passes ? d->way_in * through_i : REAL(0.0);
    d->way_out = passes ? d->way_out * t : REAL(0.0);
}

/// Light that comes along -wi, is scattered once in a slab of anisotropy g and leaves along wo
/// (Hanrahan and Krueger 1993, eq. 5): factor p / (cos_i + cos_o), to be multiplied by albedo
/// (1 - exp(-tau (1 / cos_i + 1 / cos_o))). 1/sr, no cosine.
DEVICE_FUNCTION real model_a_slab(real factor, real g, Vec3 wi, Vec3 wo) {
    return factor * henyey_greenstein_phase(g, -vec3_dot(wi, wo)) / (wi.z + wo.z);
}

#if FEATURE_WEIDLICH_WILKIE
/// Crosses one part of a material.
DEVICE_FUNCTION void model_a_cross_part(LayerRecord layer, real eta, LayerDescent* d) {
    LayerMeeting meeting;
    real through_i = REAL(1.0), through_o = REAL(1.0);
    if (layer.coverage > 0.0f) { // a sheet of flakes
        model_a_pass(d, REAL(1.0) - layer.coverage, REAL(1.0) - layer.coverage);
        return;
    }
    meeting =
        model_a_meeting((int)layer.distribution,
                        layer.reflectance == NO_INDEX ? layer.alpha : REAL(0.0), d->wi, d->wo);
    // a film's is in the tables, by each direction and wavelength
    if (layer.reflectance == NO_INDEX) {
        through_i = REAL(1.0) - fresnel_dielectric(meeting.cos_i, eta);
        through_o =
            layer.alpha > 0.0f ? through_i : REAL(1.0) - fresnel_dielectric(meeting.cos_o, eta);
    }
    model_a_cross(d, meeting, eta, through_i, through_o);
}

/// Takes two directions down the first `count` parts, absorption not included. The IOR ratios are
/// those of the records, or, with `lane_etas` not null, lane_etas[layer.eta_lanes].
DEVICE_FUNCTION LayerDescent model_a_descend(GLOBAL_CONST LayerRecord* layers, uint count,
                                             GLOBAL_CONST shared_float* lane_etas, Vec3 wi,
                                             Vec3 wo) {
    LayerDescent descent = model_a_start(wi, wo);
    for (uint k = 0u; k < count && descent.way_in > REAL(0.0); ++k)
        model_a_cross_part(layers[k], lane_etas ? lane_etas[layers[k].eta_lanes] : layers[k].eta,
                           &descent);
    return descent;
}

/// Two directions at one part of a stack, and the cosine at the facet that reflects one into the
/// other.
typedef struct {
    Vec3 wi, wo;
    real through, cos_h;
} LayerFacet;

DEVICE_FUNCTION LayerFacet model_a_facet(GLOBAL_CONST LayerRecord* layers, uint index,
                                         GLOBAL_CONST shared_float* lane_etas, Vec3 wi, Vec3 wo) {
    const LayerDescent above = model_a_descend(layers, index, lane_etas, wi, wo);
    const Vec3 h = vec3_normalise(vec3_add(above.wi, above.wo));
    LayerFacet facet;
    facet.wi = above.wi;
    facet.wo = above.wo;
    facet.through = above.way_in * above.way_out;
    facet.cos_h = fmax(vec3_dot(above.wi, h), REAL(0.0));
    return facet;
}

/// Value of a rough part's lobe between the directions just above it, seen through the parts above
/// (absorption not included, nor what is tabulated of its reflectance). 1/sr, no cosine.
DEVICE_FUNCTION real model_a_part_lobe(LayerRecord layer, real eta, LayerFacet facet) {
    real reflectance = REAL(1.0);
    if (!(facet.through > REAL(0.0)))
        return REAL(0.0);
    if (layer.coverage > 0.0f)
        reflectance = layer.coverage;
    else if (layer.reflectance == NO_INDEX)
        reflectance = fresnel_dielectric(facet.cos_h, eta);
    return facet.through * reflectance *
           microfacet_reflection((int)layer.distribution, layer.alpha, facet.wi, facet.wo);
}

/// Value of a deeper lobe at what model_a_facet says of its part; a slab's without albedo and depth
/// (model_a_slab). 1/sr, no cosine.
DEVICE_FUNCTION real model_a_nested_lobe(GLOBAL_CONST LayerRecord* layers, LobeRecord lobe,
                                         GLOBAL_CONST shared_float* lane_etas, LayerFacet facet) {
#if FEATURE_SCATTERING_SLABS
    if (lobe.slab != NO_INDEX)
        return facet.through > REAL(0.0)
                   ? model_a_slab(facet.through, lobe.alpha, facet.wi, facet.wo)
                   : REAL(0.0);
#endif
    const LayerRecord layer = layers[lobe.layer];
    return model_a_part_lobe(layer, lane_etas ? lane_etas[layer.eta_lanes] : layer.eta, facet);
}
#endif

KERNELS_END

#endif
