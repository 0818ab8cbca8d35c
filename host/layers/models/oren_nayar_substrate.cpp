#include "host/layers/models/oren_nayar_substrate.h"

#include "host/layers/stack/quadrature.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/oren_nayar.h"

#include <cmath>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

Vec3 in_lowest_slab(const Vec3& w, double ior) {
    return kernels::vec3(w.x / ior, w.y / ior, kernels::fresnel_cos_transmitted(w.z, ior));
}

Vec3 direction(double cosine, double phi) {
    const double s = std::sqrt((1.0 - cosine) * (1.0 + cosine));
    return kernels::vec3(s * std::cos(phi), s * std::sin(phi), cosine);
}

} // namespace

OrenNayarWeights oren_nayar_weights(double sigma, double lowest_ior, const Vec3& wi,
                                    const Vec3& wo) {
    const Vec3 inner_i = in_lowest_slab(wi, lowest_ior), inner_o = in_lowest_slab(wo, lowest_ior);
    const double mean = kernels::oren_nayar_mean_albedo(sigma);
    const double product =
        kernels::oren_nayar_albedo(sigma, inner_i.z) * kernels::oren_nayar_albedo(sigma, inner_o.z);
    return {std::numbers::pi * kernels::oren_nayar_value(sigma, inner_i, inner_o) - product / mean,
            product / (mean * mean)};
}

OrenNayarWeights oren_nayar_hemispherical(double sigma, double lowest_ior, double cos_i,
                                          const std::vector<double>& breaks,
                                          const std::function<double(double)>& transmission) {
    const Vec3 wi = direction(cos_i, 0.0);
    // the azimuths of one side: o is A + B max(0, cos phi) ..., smooth on [0, pi/2] and constant
    // on [pi/2, pi]
    const Quadrature& azimuths = gauss_legendre(8);
    std::vector<double> pieces = breaks;
    pieces.push_back(cos_i); // where the larger of the two angles changes
    OrenNayarWeights sum{0.0, 0.0};
    const auto integrate = [&](double OrenNayarWeights::*part) {
        return integrate_pieces(breaks_between_0_and_1(pieces), 32, [&](double c) {
            const double flux = 2.0 * c * transmission(c) / (lowest_ior * lowest_ior);
            double mean = 0.0;
            for (std::size_t k = 0; k < azimuths.nodes.size(); ++k) {
                const double phi = 0.5 * std::numbers::pi * azimuths.nodes[k];
                for (const double azimuth : {phi, std::numbers::pi - phi})
                    mean +=
                        0.5 * azimuths.weights[k] *
                        (oren_nayar_weights(sigma, lowest_ior, wi, direction(c, azimuth)).*part);
            }
            return flux * mean;
        });
    };
    sum.first = sigma > 0.0 ? integrate(&OrenNayarWeights::first) : 0.0;
    sum.rest = integrate(&OrenNayarWeights::rest);
    return sum;
}

double oren_nayar_feedback(double sigma, double diffuse,
                           const std::function<double(const SubstrateWeight&)>& integrate) {
    if (sigma == 0.0)
        return diffuse;
    const double mean = kernels::oren_nayar_mean_albedo(sigma);
    return integrate([&](double c) { return kernels::oren_nayar_albedo(sigma, c) / mean; });
}

} // namespace reradiant
