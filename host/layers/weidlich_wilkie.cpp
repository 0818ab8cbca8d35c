#include "host/layers/weidlich_wilkie.h"

#include "host/layers/interface_walk.h"
#include "kernels/fresnel.h"
#include "kernels/microfacet.h"

#include <cmath>

namespace reradiant {

using kernels::Vec3;

namespace {

/// Both directions in the medium above one interface, with what the model asks of it.
struct Crossing {
    Vec3 wi, wo;
    double eta = 1.0;
    double cos_i = 1.0, cos_o = 1.0; ///< towards the facet (half vector or normal)
    double geometry = 1.0;           ///< G of the facet
};

/// A direction of the medium above refracted at the macroscopic normal; z = 0 beyond the critical
/// angle.
Vec3 refract_macroscopic(const Vec3& w, double eta) {
    return kernels::vec3(w.x / eta, w.y / eta, kernels::fresnel_cos_transmitted(w.z, eta));
}

Crossing crossing_of(const LayerValues& layer, double eta, const Vec3& wi, const Vec3& wo) {
    Crossing crossing{wi, wo, eta, wi.z, wo.z, 1.0};
    if (layer.alpha > 0.0) {
        const Vec3 h = kernels::vec3_normalise(kernels::vec3_add(wi, wo));
        crossing.cos_i = kernels::vec3_dot(wi, h);
        crossing.cos_o = kernels::vec3_dot(wo, h);
        crossing.geometry =
            kernels::microfacet_g2(kernel_distribution(layer.distribution), layer.alpha, wi, wo, h);
    }
    return crossing;
}

double passage(double tau, double cosine) {
    return tau > 0.0 ? std::exp(-tau / cosine) : 1.0;
}

/// Calls visit(layer, crossing, wi below, wo below) for each interface from the air down, until one
/// of the directions is totally reflected. True when every interface was passed.
template <typename Visit>
bool descend(const StackValues& stack, Vec3 wi, Vec3 wo, const Visit& visit) {
    double ior = 1.0;
    for (const LayerValues& layer : stack) {
        if (wi.z <= 0.0 || wo.z <= 0.0) {
            return false;
        }
        const double eta = layer.ior / ior;
        const Crossing crossing = crossing_of(layer, eta, wi, wo);
        wi = refract_macroscopic(wi, eta);
        wo = refract_macroscopic(wo, eta);
        visit(layer, crossing, wi, wo);
        ior = layer.ior;
    }
    return wi.z > 0.0 && wo.z > 0.0;
}

/// t = (1 - G) + T21 G. T21 at the refracted direction equals T12 at the direction above.
double scattering_term(const Crossing& crossing) {
    const double t21 = 1.0 - kernels::fresnel_dielectric(crossing.cos_o, crossing.eta);
    return (1.0 - crossing.geometry) + t21 * crossing.geometry;
}

double entry_term(const Crossing& crossing) {
    return 1.0 - kernels::fresnel_dielectric(crossing.cos_i, crossing.eta);
}

} // namespace

double WeidlichWilkie::specular(const StackValues& stack, const Vec3& wi, const Vec3& wo) {
    double sum = 0.0, through = 1.0;
    descend(stack, wi, wo,
            [&](const LayerValues& layer, const Crossing& at, const Vec3& in, const Vec3& out) {
                if (layer.alpha > 0.0) {
                    sum += through * kernels::fresnel_dielectric(at.cos_i, at.eta) *
                           kernels::microfacet_reflection(kernel_distribution(layer.distribution),
                                                          layer.alpha, at.wi, at.wo);
                }
                through *= entry_term(at) * scattering_term(at) * passage(layer.tau, in.z) *
                           passage(layer.tau, out.z);
            });
    return sum;
}

double WeidlichWilkie::specular_delta(const StackValues& stack, double cos_theta) {
    const double sin_theta = std::sqrt(std::fmax(1.0 - cos_theta * cos_theta, 0.0));
    const Vec3 wi = kernels::vec3(sin_theta, 0.0, cos_theta);
    const Vec3 wo = kernels::vec3(-sin_theta, 0.0, cos_theta);
    double sum = 0.0, through = 1.0;
    descend(stack, wi, wo,
            [&](const LayerValues& layer, const Crossing& at, const Vec3& in, const Vec3& out) {
                if (layer.alpha == 0.0) {
                    sum += through * kernels::fresnel_dielectric(at.cos_i, at.eta);
                }
                through *= entry_term(at) * scattering_term(at) * passage(layer.tau, in.z) *
                           passage(layer.tau, out.z);
            });
    return sum;
}

double WeidlichWilkie::way_in(const StackValues& stack, const Vec3& wi, const Vec3& wo) {
    double product = 1.0;
    const bool passed =
        descend(stack, wi, wo,
                [&](const LayerValues& layer, const Crossing& at, const Vec3& in, const Vec3&) {
                    product *= entry_term(at) * passage(layer.tau, in.z);
                });
    return passed || stack.empty() ? product : 0.0;
}

double WeidlichWilkie::way_out(const StackValues& stack, const Vec3& wi, const Vec3& wo) {
    double product = 1.0;
    const bool passed =
        descend(stack, wi, wo,
                [&](const LayerValues& layer, const Crossing& at, const Vec3&, const Vec3& out) {
                    product *= scattering_term(at) * passage(layer.tau, out.z);
                });
    return passed || stack.empty() ? product : 0.0;
}

} // namespace reradiant
