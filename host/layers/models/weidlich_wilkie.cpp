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

/// A `Descent` holds both directions on their way down, in a medium of index `ior`, and what the
/// parts above let through each way.
struct Descent : kernels::LayerDescent {
    double ior = 1.0;

    double through() const { return way_in * way_out; }
    bool passes() const { return wi.z > 0.0 && wo.z > 0.0; }
};

enum class Part { Interface, Slab, Sheet };

double passage(double tau, double cosine) {
    return tau > 0.0 ? std::exp(-tau / cosine) : 1.0;
}

/// A film lets through what it does not reflect at the normal of the surface, however rough.
void cross_interface(const LayerValues& layer, Descent& d) {
    const double alpha = layer.film.thickness_nm == 0.0 ? layer.alpha : 0.0;
    const kernels::LayerMeeting meeting =
        kernels::model_a_meeting(kernel_distribution(layer.distribution), alpha, d.wi, d.wo);
    kernels::model_a_cross(&d, meeting, layer.ior / d.ior,
                           1.0 - facet_reflectance(layer, d.ior, meeting.cos_i),
                           1.0 - facet_reflectance(layer, d.ior, meeting.cos_o));
    d.ior = layer.ior;
}

/// Calls visit(layer, part, descent) with the directions just above each part from the air down,
/// until one of them is totally reflected; returns what arrives at the substrate.
template <typename Visit>
Descent descend(const StackValues& stack, const Vec3& wi, const Vec3& wo, const Visit& visit) {
    Descent d{kernels::model_a_start(wi, wo)};
    if (!d.passes())
        kernels::model_a_pass(&d, 0.0, 0.0);
    for (const LayerValues& layer : stack) {
        if (!d.passes())
            return d;
        visit(layer, Part::Interface, d);
        cross_interface(layer, d);
        if (!d.passes())
            return d;
        visit(layer, Part::Slab, d);
        const double tau = layer.tau + layer.tau_scattering;
        kernels::model_a_pass(&d, passage(tau, d.wi.z), passage(tau, d.wo.z));
        if (layer.flake_coverage > 0.0) {
            visit(layer, Part::Sheet, d);
            kernels::model_a_pass(&d, 1.0 - layer.flake_coverage, 1.0 - layer.flake_coverage);
        }
    }
    return d;
}

Descent arrive(const StackValues& stack, const Vec3& wi, const Vec3& wo) {
    return descend(stack, wi, wo, [](const LayerValues&, Part, const Descent&) {});
}

/// F D G / (4 ci co) of an interface or a conductor; 0 where it is smooth.
template <typename Reflector>
double facet_lobe(const Reflector& reflector, const Descent& d) {
    if (!(reflector.alpha > 0.0))
        return 0.0;
    const Vec3 h = kernels::vec3_normalise(kernels::vec3_add(d.wi, d.wo));
    return facet_reflectance(reflector, d.ior, kernels::vec3_dot(d.wi, h)) *
           kernels::microfacet_reflection(kernel_distribution(reflector.distribution),
                                          reflector.alpha, d.wi, d.wo);
}

template <typename Reflector>
double mirror(const Reflector& reflector, const Descent& d) {
    return reflector.alpha > 0.0 ? 0.0 : facet_reflectance(reflector, d.ior, d.wi.z);
}

/// Light that a slab scatters once.
double slab_lobe(const LayerValues& layer, const Descent& d) {
    if (!(layer.tau_scattering > 0.0))
        return 0.0;
    const double tau = layer.tau + layer.tau_scattering;
    return kernels::model_a_slab(-layer.tau_scattering / tau, layer.anisotropy, d.wi, d.wo) *
           std::expm1(-tau * (1.0 / d.wi.z + 1.0 / d.wo.z));
}

double part_lobe(const LayerValues& layer, Part part, const Descent& d) {
    switch (part) {
    case Part::Interface:
        return facet_lobe(layer, d);
    case Part::Slab:
        return slab_lobe(layer, d);
    case Part::Sheet:
        break;
    }
    return layer.flake_coverage * facet_lobe(layer.flakes, d);
}

double part_mirror(const LayerValues& layer, Part part, const Descent& d) {
    switch (part) {
    case Part::Interface:
        return mirror(layer, d);
    case Part::Slab:
        return 0.0;
    case Part::Sheet:
        break;
    }
    return layer.flake_coverage * mirror(layer.flakes, d);
}

struct MirrorPair {
    Vec3 wi, wo;
};
MirrorPair mirror_pair(double cos_theta) {
    const double sin_theta = std::sqrt(std::fmax(1.0 - cos_theta * cos_theta, 0.0));
    return {kernels::vec3(sin_theta, 0.0, cos_theta), kernels::vec3(-sin_theta, 0.0, cos_theta)};
}

} // namespace

double WeidlichWilkie::specular(const StackValues& stack, const Vec3& wi, const Vec3& wo) {
    double sum = 0.0;
    descend(stack, wi, wo, [&](const LayerValues& layer, Part part, const Descent& d) {
        sum += d.through() * part_lobe(layer, part, d);
    });
    return sum;
}

double WeidlichWilkie::specular_delta(const StackValues& stack, double cos_theta) {
    const auto [wi, wo] = mirror_pair(cos_theta);
    double sum = 0.0;
    descend(stack, wi, wo, [&](const LayerValues& layer, Part part, const Descent& d) {
        sum += d.through() * part_mirror(layer, part, d);
    });
    return sum;
}

double WeidlichWilkie::way_in(const StackValues& stack, const Vec3& wi, const Vec3& wo) {
    return arrive(stack, wi, wo).way_in;
}

double WeidlichWilkie::way_out(const StackValues& stack, const Vec3& wi, const Vec3& wo) {
    return arrive(stack, wi, wo).way_out;
}

double WeidlichWilkie::diffuse_shape(const StackValues& stack, double sigma, const Vec3& wi,
                                     const Vec3& wo) {
    if (sigma == 0.0)
        return 1.0;
    const Descent d = arrive(stack, wi, wo);
    return std::numbers::pi * kernels::oren_nayar_value(sigma, d.wi, d.wo);
}

double WeidlichWilkie::conductor(const StackValues& stack, const ConductorValues& conductor,
                                 const Vec3& wi, const Vec3& wo) {
    const Descent d = arrive(stack, wi, wo);
    return d.passes() ? d.through() * facet_lobe(conductor, d) : 0.0;
}

double WeidlichWilkie::conductor_delta(const StackValues& stack, const ConductorValues& conductor,
                                       double cos_theta) {
    const auto [wi, wo] = mirror_pair(cos_theta);
    const Descent d = arrive(stack, wi, wo);
    return d.passes() ? d.through() * mirror(conductor, d) : 0.0;
}

} // namespace reradiant
