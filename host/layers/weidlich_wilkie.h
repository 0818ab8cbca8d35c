#pragma once

#include "host/layers/stack.h"
#include "kernels/portable.h"

namespace reradiant {

/// Model A (`weidlich-wilkie`), Weidlich and Wilkie 2007: for unit vectors in the local frame
/// (z = normal, both above the surface). Nested: each rough or smooth interface adds its
/// Torrance-Sparrow lobe, seen through the interfaces above by T12, a and t (DESIGN 2 A).
/// Directions refract at the macroscopic normal; the half vector of a rough interface is that
/// of the directions just above it; a smooth interface uses the normal.
struct WeidlichWilkie {
    /// Sum of all rough interfaces' lobes at one wavelength, 1/sr, no cosine.
    static double specular(const StackValues& stack, const kernels::Vec3& wi,
                           const kernels::Vec3& wo);
    /// Weight of the mirror delta from the smooth interfaces.
    static double specular_delta(const StackValues& stack, double cos_theta);
    /// Product of T12 and exp(-tau / cos) on the way in, at the excitation wavelength.
    static double way_in(const StackValues& stack, const kernels::Vec3& wi,
                         const kernels::Vec3& wo);
    /// Product of t = (1 - G) + T21 G and exp(-tau / cos) on the way out, at the emission
    /// wavelength. f_diffuse = way_out(lo) M(lo, li) way_in(li) / pi.
    static double way_out(const StackValues& stack, const kernels::Vec3& wi,
                          const kernels::Vec3& wo);
};

} // namespace reradiant
