#pragma once

#include "host/layers/stack/cosine_nodes.h"
#include "kernels/core/portable.h"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace reradiant {

/// An Oren-Nayar substrate under a stack (model adding). The substrate's BSDF is M o(wi', wo'), o =
/// oren_nayar_value and ' = directions in the lowest slab (IOR n_k). Light that comes back is
/// followed with a separable kernel M e(wi) e(wo) / (pi Em) instead, Em = oren_nayar_mean_albedo,
/// which makes the series of interreflections a geometric one:
///
/// f = T(wo; lo) T(wi; li) / (pi n_k^2) { pi o(wi', wo') M + e(wi) e(wo) / Em^2 [B - Em M] }
/// B = Em M (I - diag(r) Em M)^-1.
///
/// With R(c, c') what the stack sends back of light that leaves the substrate, the series is that
/// of o R o, o R o R o, ..., o its mean over azimuths. Em r and e are its largest eigenvalue and
/// the eigenfunction, scaled so that the series' terms are those of the eigenvalue: energy is right
/// to the squares of the other eigenvalues, which are small. Absorption hardly changes e, which is
/// that of the stack without it, so that it serves all wavelengths; r = <e, R e> / Em^2. The first
/// bounce is exact in angle; where rough interfaces or slabs that scatter spread light on its way,
/// o is the mean over the directions in which it arrives
/// (host/layers/angular/substrate_arrivals.h). For sigma 0 this is the Lambertian formula (f = T T
/// B / (pi n_k^2)). Reciprocal. In terms of two operators: f = T T / (pi n_k^2) { first M + rest B
/// }.
struct OrenNayarWeights {
    double first; ///< pi o - e e / Em, negative where o is below its separable form
    double rest;  ///< e e / Em^2
};

/// Tables by direction in air, as kernels/scatter/oren_nayar_shape.h reads them: e, and pi o where
/// light is spread; `spread` is empty where it is refracted alone.
struct OrenNayarTables {
    std::vector<float> albedo, spread;
};

/// An Oren-Nayar substrate beneath a stack at one wavelength; without tables for sigma 0.
struct OrenNayarBeneath {
    double sigma;
    double lowest_ior;
    const OrenNayarTables* tables = nullptr;
};

/// `wi`, `wo` in air, unit vectors above the surface.
OrenNayarWeights oren_nayar_weights(const OrenNayarBeneath& substrate, const kernels::Vec3& wi,
                                    const kernels::Vec3& wo);

/// Returns the integrals of the two weights times T(wo) cos(wo) / (pi n_k^2) over outgoing
/// directions: the factors of M and B in a directional-hemispherical reflectance, T(wi) left out.
/// `transmission` is T by cosine in air, `breaks` the pieces of its quadrature over that cosine.
OrenNayarWeights oren_nayar_hemispherical(const OrenNayarBeneath& substrate, double cos_i,
                                          const std::vector<double>& breaks,
                                          const std::function<double(double)>& transmission);

/// Azimuthal mean of pi o between two cosines in the lowest slab.
double oren_nayar_mean_value(double sigma, double cos_i, double cos_o);

/// The separable kernel beneath a stack.
struct SeparableOrenNayar {
    Eigen::VectorXd albedo; ///< e by node, of light that arrives at its cosine in the lowest slab
    /// By node, u: e is the sum over the nodes' cosines c of u(c) times the mean of pi o between c
    /// and what arrives.
    Eigen::VectorXd arriving;
};

/// `returned` is what comes back of diffuse emission weighted by one node's function of the cosine,
/// weighted by another's: (nodes, nodes), sum r for sigma 0.
SeparableOrenNayar separable_oren_nayar(double sigma, const CosineNodes& nodes,
                                        const Eigen::MatrixXd& returned);
/// Returns r from what comes back of a stack, and e of that stack or of one much like it.
double separable_internal_reflectance(double sigma, const SeparableOrenNayar& kernel,
                                      const Eigen::MatrixXd& returned);

} // namespace reradiant
