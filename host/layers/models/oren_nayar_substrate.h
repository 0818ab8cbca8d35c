#pragma once

#include "host/layers/angular/angular_piles.h"
#include "kernels/core/portable.h"

#include <functional>

namespace reradiant {

/// An Oren-Nayar substrate under a stack (model adding). The substrate's BSDF is M o(wi', wo'), o =
/// oren_nayar_value and ' = directions in the lowest slab (IOR n_k), refracted at the macroscopic
/// normal. Light that comes back is followed with the separable kernel M E(ci') E(co') / (pi Em)
/// instead, E = oren_nayar_albedo and Em its mean: it has the same directional albedos, so that
/// energy stays right, and it makes the series of interreflections a geometric one:
///
/// f = T(wo; lo) T(wi; li) / (pi n_k^2) { pi o(wi', wo') M + E(ci') E(co') / Em^2 [B - Em M] }
/// B = Em M (I - diag(r_E) Em M)^-1,
/// r_E = integrals of E(c_in) R_up(c_in, c_out) E(c_out) over emitted and returned light, / Em^2.
///
/// Exact in angle for the first bounce under smooth interfaces; exact in all for sigma 0, where it
/// is the Lambertian formula (f = T T B / (pi n_k^2)). Reciprocal. In terms of two operators:
/// f = T T / (pi n_k^2) { first M + rest B }.
struct OrenNayarWeights {
    double first; ///< pi o - E E / Em, negative where o is below its separable form
    double rest;  ///< E E / Em^2
};

/// `wi`, `wo` in air, unit vectors above the surface.
OrenNayarWeights oren_nayar_weights(double sigma, double lowest_ior, const kernels::Vec3& wi,
                                    const kernels::Vec3& wo);

/// Returns the integrals of the two weights times T(wo) cos(wo) / (pi n_k^2) over outgoing
/// directions: the factors of M and B in a directional-hemispherical reflectance, T(wi) left out.
/// `transmission` is T by cosine in air, `breaks` the pieces of its quadrature over that cosine.
OrenNayarWeights oren_nayar_hemispherical(double sigma, double lowest_ior, double cos_i,
                                          const std::vector<double>& breaks,
                                          const std::function<double(double)>& transmission);

/// r_E from a function that integrates the returned light for a weight of the substrate, which gets
/// E / Em; `diffuse` is the result for weight 1, returned for sigma 0.
double oren_nayar_feedback(double sigma, double diffuse,
                           const std::function<double(const SubstrateWeight&)>& integrate);

} // namespace reradiant
