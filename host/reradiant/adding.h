#pragma once

#include "reradiant/layer_stack.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// Model B (`adding`) of the stack above the substrate at one wavelength, double precision.
///
/// Diffuse part: f = T(cos_o; lo) [M (I - diag(r) M)^-1](lo, li) T(cos_i; li) / (pi n_k(lo)^2).
///
/// Specular part (light that never reached the substrate), no cosine, 1/sr:
///   delta of weight `specular_delta(c)` towards the mirror direction
/// + rough top interface: F(wi.h) D(h) G2 / (4 ci co), single scattering
/// (kernels/scatter/microfacet.h)
/// + sum over deeper rough lobes l: a_l(ci) a_l(co) D_l(h) G2_l / (4 ci co), h = half vector in
///   air, a_l >= 0 tabulated so that the lobe carries the flux that its interface sends back
/// + residual(ci) residual(co) / (pi residual_average): what is left of the specular flux
///   (multiple scattering between facets and layers, and what slabs scatter back), reciprocal
///   (Kelemen-Szirmay-Kalos 2001).
/// The integral over co of everything equals `specular_albedo(ci)`.
class AddingTransport {
public:
    virtual ~AddingTransport() = default;

    /// Share of the flux from air direction cos_theta that arrives at the substrate.
    virtual double transmission(double cos_theta) const = 0;
    /// Share r of diffusely emitted flux that comes back down to the substrate.
    virtual double internal_reflectance() const = 0;
    /// Returns the internal reflectance for an Oren-Nayar substrate of width sigma: light is
    /// emitted and counted with the weights of its directional albedo
    /// (host/layers/models/oren_nayar_substrate.h). sigma = 0 gives the value for diffuse emission.
    virtual double internal_reflectance(double sigma) const = 0;
    /// IOR n_k of the medium above the substrate (1 for a bare one).
    virtual double lowest_ior() const = 0;
    /// Share of the flux from cos_theta that leaves again without reaching the substrate.
    virtual double specular_albedo(double cos_theta) const = 0;

    virtual double specular_delta(double cos_theta) const = 0;
    struct Lobe {
        Distribution distribution;
        double alpha;
    };
    /// True when the top interface is rough (alpha and distribution of the first layer).
    virtual bool has_top_lobe() const = 0;
    virtual const std::vector<Lobe>& deeper_lobes() const = 0;
    virtual double lobe_amplitude(int lobe, double cos_theta) const = 0;
    virtual double residual(double cos_theta) const = 0;
    /// 2 * integral residual(c) c dc.
    virtual double residual_average() const = 0;
    /// Energy lost to single scattering on the way (0 for `multiple`): directional-hemispherical
    /// share that is neither reflected, transmitted nor absorbed.
    virtual double lost(double cos_theta) const = 0;
};

/// Returns why adding cannot do a stack, or nothing if it can: it knows no flakes, and an operator
/// of a rough interface for each wavelength of a film costs too much (about a second each).
std::optional<std::string> adding_refusal(const LayerStack& stack);

/// Returns the transport of a stack. It is cheap for smooth clear stacks (closed form); for rough
/// ones the interfaces' scattering operators are computed once per (IOR ratio, distribution, alpha,
/// scattering) and kept in memory and in the disk cache; slabs that scatter take some 10 ms each.
/// Thread-safe. Throws an input Error for numbers out of range and for what adding cannot do.
std::shared_ptr<const AddingTransport> adding_transport(const StackValues& stack);

} // namespace reradiant
