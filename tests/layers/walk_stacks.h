#pragma once

#include "host/layers/models/effective_matrix.h"
#include "host/layers/stack/quadrature.h"
#include "host/layers/walk/walk_estimate.h"
#include "reradiant/stack_model.h"
#include "tests/support/directions.h"

#include <cmath>
#include <numbers>
#include <vector>

/// Stacks and what adding says of them, for comparisons with the walk.
namespace reradiant {

inline Layer plain_layer(double ior, double alpha, double tau,
                         Scattering scattering = Scattering::Multiple,
                         Distribution distribution = Distribution::Ggx) {
    Layer layer;
    layer.ior = Spectrum::constant(ior);
    layer.alpha = alpha;
    layer.distribution = distribution;
    layer.scattering = scattering;
    layer.absorption = Spectrum::constant(tau);
    return layer;
}
inline Layer cloudy_layer(double ior, double alpha, double tau, double tau_scattering,
                          double anisotropy) {
    Layer layer = plain_layer(ior, alpha, tau);
    layer.scattering_coefficient = Spectrum::constant(tau_scattering);
    layer.anisotropy = anisotropy;
    return layer;
}

/// Reflects at both of its bands, 400 and 600 nm, and shifts light from one to the other.
inline const std::vector<double> two_bands_nm{400.0, 600.0};
inline Eigen::MatrixXd bispectral_matrix() {
    Eigen::MatrixXd m(2, 2);
    m << 0.2, 0.0, 0.4, 0.5;
    return m;
}

/// Adding's diffuse BRRDF, 1/sr, and its directional-hemispherical specular share, over a
/// Lambertian substrate with that matrix.
struct AddingValues {
    Eigen::MatrixXd diffuse;
    Eigen::VectorXd specular_albedo;
};
inline AddingValues adding_values(const LayerStack& stack, const kernels::Vec3& wi,
                                  const kernels::Vec3& wo) {
    Eigen::VectorXd r(2), in(2), out(2), specular(2);
    for (Eigen::Index band = 0; band < 2; ++band) {
        const auto t =
            adding_transport(stack_at(stack, two_bands_nm[static_cast<std::size_t>(band)]));
        r(band) = t->internal_reflectance();
        in(band) = t->transmission(wi.z);
        out(band) =
            t->transmission(wo.z) * std::numbers::inv_pi / (t->lowest_ior() * t->lowest_ior());
        specular(band) = t->specular_albedo(wi.z);
    }
    return {out.asDiagonal() * effective_matrix(bispectral_matrix(), r) * in.asDiagonal(),
            specular};
}

} // namespace reradiant
