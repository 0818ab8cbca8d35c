#include "host/layers/models/oren_nayar_substrate.h"

#include "host/layers/stack/quadrature.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/oren_nayar.h"
#include "kernels/scatter/oren_nayar_shape.h"

#include <algorithm>
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

OrenNayarWeights oren_nayar_weights(const OrenNayarBeneath& substrate, const Vec3& wi,
                                    const Vec3& wo) {
    const double sigma = substrate.sigma;
    if (!substrate.tables)
        return {0.0, 1.0};
    const OrenNayarTables& tables = *substrate.tables;
    const double n = substrate.lowest_ior, mean = kernels::oren_nayar_mean_albedo(sigma);
    const double value =
        tables.spread.empty()
            ? std::numbers::pi *
                  kernels::oren_nayar_value(sigma, in_lowest_slab(wi, n), in_lowest_slab(wo, n))
            : kernels::oren_nayar_spread_value(tables.spread.data(), wi, wo);
    const double product = kernels::oren_nayar_separable_albedo(tables.albedo.data(), wi.z) *
                           kernels::oren_nayar_separable_albedo(tables.albedo.data(), wo.z);
    return {value - product / mean, product / (mean * mean)};
}

OrenNayarWeights oren_nayar_hemispherical(const OrenNayarBeneath& substrate, double cos_i,
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
            const double flux =
                2.0 * c * transmission(c) / (substrate.lowest_ior * substrate.lowest_ior);
            double mean = 0.0;
            for (std::size_t k = 0; k < azimuths.nodes.size(); ++k) {
                const double phi = 0.5 * std::numbers::pi * azimuths.nodes[k];
                for (const double azimuth : {phi, std::numbers::pi - phi})
                    mean += 0.5 * azimuths.weights[k] *
                            (oren_nayar_weights(substrate, wi, direction(c, azimuth)).*part);
            }
            return flux * mean;
        });
    };
    sum.first = substrate.sigma > 0.0 ? integrate(&OrenNayarWeights::first) : 0.0;
    sum.rest = integrate(&OrenNayarWeights::rest);
    return sum;
}

double oren_nayar_mean_value(double sigma, double cos_i, double cos_o) {
    const auto sine = [](double c) { return std::sqrt((1.0 - c) * (1.0 + c)); };
    const double larger = std::max(cos_i, cos_o);
    const double shape = larger > 0.0 ? sine(cos_i) * sine(cos_o) / larger : 0.0;
    return kernels::oren_nayar_a(sigma) +
           kernels::oren_nayar_b(sigma) * std::numbers::inv_pi * shape;
}

namespace {

/// Shares of a diffuse flux by node; their sum is 1.
Eigen::VectorXd diffuse_shares(const CosineNodes& nodes) {
    Eigen::VectorXd shares(nodes.size());
    const double step = nodes.cosine(1);
    for (Eigen::Index node = 0; node < nodes.size(); ++node)
        shares(node) = 2.0 * nodes.cosine(node) * step;
    shares(0) = step * step / 3.0;
    shares(nodes.size() - 1) = step * (1.0 - step / 3.0);
    return shares;
}

} // namespace

SeparableOrenNayar separable_oren_nayar(double sigma, const CosineNodes& nodes,
                                        const Eigen::MatrixXd& returned) {
    const double mean = kernels::oren_nayar_mean_albedo(sigma);
    Eigen::MatrixXd value(nodes.size(), nodes.size());
    Eigen::VectorXd function(nodes.size());
    for (Eigen::Index i = 0; i < nodes.size(); ++i) {
        function(i) = kernels::oren_nayar_albedo(sigma, nodes.cosine(i));
        for (Eigen::Index o = 0; o < nodes.size(); ++o)
            value(i, o) = oren_nayar_mean_value(sigma, nodes.cosine(i), nodes.cosine(o));
    }
    const Eigen::MatrixXd both_ways = 0.5 * (returned + returned.transpose());
    double eigenvalue = 0.0;
    constexpr int steps = 8; // the next eigenvalue is some hundredth of the largest
    for (int step = 0; step < steps; ++step) {
        const Eigen::VectorXd back = both_ways * function;
        const double norm = function.dot(back);
        if (!(norm > 1e-15)) // nothing comes back
            return {function, diffuse_shares(nodes)};
        function = value * back / std::sqrt(norm);
        eigenvalue = back.dot(function) / std::sqrt(norm);
    }
    function /= std::sqrt(function.dot(both_ways * function));
    return {std::sqrt(mean * eigenvalue) * function,
            std::sqrt(mean / eigenvalue) * (both_ways * function)};
}

double separable_internal_reflectance(double sigma, const SeparableOrenNayar& kernel,
                                      const Eigen::MatrixXd& returned) {
    const double mean = kernels::oren_nayar_mean_albedo(sigma);
    return kernel.albedo.dot(returned * kernel.albedo) / (mean * mean);
}

} // namespace reradiant
