#pragma once

#include "kernels/core/portable.h"
#include "reradiant/stack_elements.h"

namespace reradiant {

/// Model A (`weidlich-wilkie`), Weidlich and Wilkie 2007: for unit vectors in the local frame
/// (z = normal, both above the surface), at one wavelength. Nested: each part of the stack adds its
/// own BRDF at the directions refracted down to it, seen through the parts above by T12, a and t
/// (Weidlich and Wilkie 2007); no n^2 factors, as published. Directions refract at the
/// macroscopic normal.
///
/// - interface: Torrance-Sparrow, F D G / (4 ci co), or a mirror where it is smooth. The half
///   vector is that of the directions just above it; a smooth interface uses the normal. One that
///   bears a film reflects coherently at its facets and lets through what it does not reflect at
///   the normal of the surface, without G (T = 1 - R at each direction).
/// - slab: a = exp(-(tau + tau_scattering) / cos) each way; single scattering after Hanrahan and
///   Krueger 1993, eq. 5.
/// - sheet of flakes, at the lower end of its slab: reflects `coverage` of the light with the
///   reflector's lobe (a mirror for alpha 0) and lets 1 - coverage pass each way.
/// - substrate: a re-radiation matrix over pi, times Oren-Nayar's shape; or a conductor, F D G /
///   (4 ci co) with complex Fresnel, or a mirror.
///
/// All this is single scattering between facets. What `multiple` adds is the residual of
/// host/layers/models/weidlich_wilkie_residual.h, to the reflection alone: T12, a and t stay as
/// published.
struct WeidlichWilkie {
    /// Lobes of rough interfaces and flakes and the light that slabs scatter once, 1/sr, no cosine.
    static double specular(const StackElements& stack, const kernels::Vec3& wi,
                           const kernels::Vec3& wo);
    /// Weight of the mirror delta from smooth interfaces and flakes.
    static double specular_delta(const StackElements& stack, double cos_theta);
    /// Product of T12 and exp(-tau / cos) on the way in, at the excitation wavelength.
    static double way_in(const StackElements& stack, const kernels::Vec3& wi,
                         const kernels::Vec3& wo);
    /// Product of t = (1 - G) + T21 G and exp(-tau / cos) on the way out, at the emission
    /// wavelength. f_diffuse = way_out(lo) M(lo, li) way_in(li) diffuse_shape(lo) / pi.
    static double way_out(const StackElements& stack, const kernels::Vec3& wi,
                          const kernels::Vec3& wo);
    /// pi f / rho of an Oren-Nayar substrate at the refracted directions; 1 for sigma 0.
    static double diffuse_shape(const StackElements& stack, double sigma, const kernels::Vec3& wi,
                                const kernels::Vec3& wo);
    /// The conductor at the end of the stack seen through it, its lobe (1/sr, no cosine; 0 if
    /// smooth) and the weight of its mirror delta (0 if rough); 0 where there is none.
    static double conductor(const StackElements& stack, const kernels::Vec3& wi,
                            const kernels::Vec3& wo);
    static double conductor_delta(const StackElements& stack, double cos_theta);
};

} // namespace reradiant
