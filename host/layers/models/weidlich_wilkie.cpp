#include "host/layers/models/weidlich_wilkie.h"

#include "host/layers/rough/facet_reflectance.h"
#include "kernels/scatter/microfacet.h"
#include "kernels/scatter/oren_nayar.h"
#include "kernels/stack/model_a.h"

#include <cmath>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

/// A `Descent` holds both directions on their way down, and what the parts above let through each
/// way.
struct Descent : kernels::LayerDescent {

    double through() const { return way_in * way_out; }
    bool passes() const { return wi.z > 0.0 && wo.z > 0.0; }
};

double passage(double tau, double cosine) {
    return tau > 0.0 ? std::exp(-tau / cosine) : 1.0;
}

/// A film lets through what it does not reflect at the normal of the surface, however rough.
void cross_interface(const SurfaceValues& surface, Descent& d) {
    const double alpha = surface.has_film() ? 0.0 : surface.alpha;
    const kernels::LayerMeeting meeting =
        kernels::model_a_meeting(kernel_distribution(surface.distribution), alpha, d.wi, d.wo);
    kernels::model_a_cross(&d, meeting, surface.ior_below / surface.ior_above,
                           1.0 - facet_reflectance(surface, meeting.cos_i),
                           1.0 - facet_reflectance(surface, meeting.cos_o));
}

void cross(const StackElement& element, Descent& d) {
    if (const auto* slab = std::get_if<SlabValues>(&element)) {
        kernels::model_a_pass(&d, passage(slab->depth(), d.wi.z), passage(slab->depth(), d.wo.z));
    } else if (const auto* flakes = std::get_if<FlakesValues>(&element)) {
        kernels::model_a_pass(&d, 1.0 - flakes->coverage, 1.0 - flakes->coverage);
    } else {
        cross_interface(std::get<SurfaceValues>(element), d);
    }
}

/// Calls visit(element, descent) with the directions just above each element above the substrate,
/// until one of them is totally reflected; returns what arrives at the substrate.
template <typename Visit>
Descent descend(const StackElements& stack, const Vec3& wi, const Vec3& wo, const Visit& visit) {
    Descent d{kernels::model_a_start(wi, wo)};
    if (!d.passes())
        kernels::model_a_pass(&d, 0.0, 0.0);
    for (const StackElement& element : above_substrate(stack)) {
        if (!d.passes())
            return d;
        visit(element, d);
        cross(element, d);
    }
    return d;
}

Descent arrive(const StackElements& stack, const Vec3& wi, const Vec3& wo) {
    return descend(stack, wi, wo, [](const StackElement&, const Descent&) {});
}

/// F D G / (4 ci co) of a surface; 0 where it is smooth.
double facet_lobe(const SurfaceValues& surface, const Descent& d) {
    if (!(surface.alpha > 0.0))
        return 0.0;
    const Vec3 h = kernels::vec3_normalise(kernels::vec3_add(d.wi, d.wo));
    return facet_reflectance(surface, kernels::vec3_dot(d.wi, h)) *
           kernels::microfacet_reflection(kernel_distribution(surface.distribution), surface.alpha,
                                          d.wi, d.wo);
}

double mirror(const SurfaceValues& surface, const Descent& d) {
    return surface.alpha > 0.0 ? 0.0 : facet_reflectance(surface, d.wi.z);
}

/// Light that a slab scatters once.
double slab_lobe(const SlabValues& slab, const Descent& d) {
    if (!slab.scatters())
        return 0.0;
    const double tau = slab.depth();
    return kernels::model_a_slab(-slab.tau_scattering / tau, slab.anisotropy, d.wi, d.wo) *
           std::expm1(-tau * (1.0 / d.wi.z + 1.0 / d.wo.z));
}

double lobe_of(const StackElement& element, const Descent& d) {
    if (const auto* slab = std::get_if<SlabValues>(&element))
        return slab_lobe(*slab, d);
    return coverage_of(element) * facet_lobe(*surface_of(element), d);
}

double mirror_of(const StackElement& element, const Descent& d) {
    const SurfaceValues* surface = surface_of(element);
    return surface ? coverage_of(element) * mirror(*surface, d) : 0.0;
}

struct MirrorPair {
    Vec3 wi, wo;
};
MirrorPair mirror_pair(double cos_theta) {
    const double sin_theta = std::sqrt(std::fmax(1.0 - cos_theta * cos_theta, 0.0));
    return {kernels::vec3(sin_theta, 0.0, cos_theta), kernels::vec3(-sin_theta, 0.0, cos_theta)};
}

} // namespace

double WeidlichWilkie::specular(const StackElements& stack, const Vec3& wi, const Vec3& wo) {
    double sum = 0.0;
    descend(stack, wi, wo, [&](const StackElement& element, const Descent& d) {
        sum += d.through() * lobe_of(element, d);
    });
    return sum;
}

double WeidlichWilkie::specular_delta(const StackElements& stack, double cos_theta) {
    const auto [wi, wo] = mirror_pair(cos_theta);
    double sum = 0.0;
    descend(stack, wi, wo, [&](const StackElement& element, const Descent& d) {
        sum += d.through() * mirror_of(element, d);
    });
    return sum;
}

double WeidlichWilkie::way_in(const StackElements& stack, const Vec3& wi, const Vec3& wo) {
    return arrive(stack, wi, wo).way_in;
}

double WeidlichWilkie::way_out(const StackElements& stack, const Vec3& wi, const Vec3& wo) {
    return arrive(stack, wi, wo).way_out;
}

double WeidlichWilkie::diffuse_shape(const StackElements& stack, double sigma, const Vec3& wi,
                                     const Vec3& wo) {
    if (sigma == 0.0)
        return 1.0;
    const Descent d = arrive(stack, wi, wo);
    return std::numbers::pi * kernels::oren_nayar_value(sigma, d.wi, d.wo);
}

double WeidlichWilkie::conductor(const StackElements& stack, const Vec3& wi, const Vec3& wo) {
    const SurfaceValues* conductor = conductor_of(stack);
    if (!conductor)
        return 0.0;
    const Descent d = arrive(stack, wi, wo);
    return d.passes() ? d.through() * facet_lobe(*conductor, d) : 0.0;
}

double WeidlichWilkie::conductor_delta(const StackElements& stack, double cos_theta) {
    const SurfaceValues* conductor = conductor_of(stack);
    if (!conductor)
        return 0.0;
    const auto [wi, wo] = mirror_pair(cos_theta);
    const Descent d = arrive(stack, wi, wo);
    return d.passes() ? d.through() * mirror(*conductor, d) : 0.0;
}

} // namespace reradiant
