#pragma once

#include "host/layers/rough/specular_lobes.h"
#include "reradiant/stack_elements.h"

namespace reradiant {

/// A `WeidlichWilkieResidual` is what the scattering `multiple` adds to model A at one wavelength:
/// the light that rough interfaces, flakes and a conductor substrate send back after more than one
/// event at their facets, in the reciprocal form of adding's residual (Kelemen and Szirmay-Kalos
/// 2001),
///
///   f = r(ci) r(co) / (pi average),  r = sum over parts of V(c) m(c') e,
///
/// where m(c') is the part's own share (facet_interreflection.h) at the cosine above it, V(c) is
/// what the parts above let through one way at the normal of the surface (1 - F, extinction and
/// flakes), and e is the share of the part's light that comes out: 2 integral V(c) m(c') c dc over
/// m's own mean, as model A has no n^2 factors. An interface with nothing above it thus reflects
/// all that its operator says. The residual is zero for `single` and for smooth stacks.
class WeidlichWilkieResidual {
public:
    explicit WeidlichWilkieResidual(const StackElements& stack);

    /// Albedo r of the residual for light from cos_theta, unit 1.
    double operator()(double cos_theta) const { return total_(cos_theta); }
    /// 2 integral r(c) c dc; 0 when there is none.
    double average() const { return average_; }
    /// 1/sr, no cosine.
    double value(double cos_i, double cos_o) const;
    /// The part of r that the conductor substrate sends back.
    double conductor_part(double cos_theta) const { return conductor_(cos_theta); }

private:
    CosineTable total_, conductor_;
    double average_ = 0.0;
};

} // namespace reradiant
