#pragma once

#include "reradiant/stack_elements.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// A rough interface that the light of a deeper lobe passes on both ways.
struct LobePassage {
    double alpha, ior_above, ior_below;
};

/// The shape D G2 of a rough surface's lobe, over the half vector in air. Its width is alpha for
/// facets in air; for those of an interface deeper in a stack it follows from their own alpha, the
/// medium above them and the passages, as kernels/scatter/lobe_width.h says.
struct LobeShape {
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0;
    /// Ratio that the lobe is multiplied by; null: 1.
    std::shared_ptr<const std::vector<float>> table = nullptr;
    /// What the table is: of light between facets (kernels/scatter/facet_shape.h), or else one of
    /// kernels/scatter/lobe_ratio.h, which takes the direction on the lobe's side first or second,
    /// or is added up over both.
    enum class Table { Facets, OwnFirst, OwnSecond, Sum } table_kind = Table::Facets;
    bool is_between_facets() const { return table && table_kind == Table::Facets; }
    double ior = 0.0; ///< of the medium above a deeper interface; 0: facets in air
    std::vector<LobePassage> passages{};
    std::size_t element = 0; ///< of the stack, that reflects
};

/// A `StackModel` is what a closed model says of a stack at one wavelength, in double precision, by
/// the cosine of a direction in air. `adding` (model B) counts every
/// interreflection, `weidlich-wilkie` (model A, host/layers/models/weidlich_wilkie.h) none. What
/// either says of two directions is a StackBsdf (host/layers/models/stack_bsdf.h).
///
/// Diffuse part of adding:
///   f = T(cos_o; lo) [M (I - diag(r) M)^-1](lo, li) T(cos_i; li) / (pi n_k(lo)^2).
///
/// Specular part (light that never reached the substrate), no cosine, 1/sr:
///   delta of weight `specular_delta(c)` towards the mirror direction
/// + rough top interface: F(wi.h) D(h) G2 / (4 ci co), single scattering
/// (kernels/scatter/microfacet.h)
/// + sum over further rough lobes l: a_l(ci) a_l(co) D_l(h) G2_l / (4 ci co), h = half vector in
///   air (adding; under weidlich-wilkie the lobe itself is that of the directions refracted down).
///   Under adding the first of them, times a tabulated ratio, is the light that the top interface's
///   facets scatter more than once (ggx and beckmann, `multiple`); the others are deeper
///   interfaces'
/// + residual(ci) residual(co) / (pi residual_average): what is left of the specular flux (light
///   between the facets of blinn and of deeper interfaces, between layers, and what slabs scatter
///   back), reciprocal (Kelemen-Szirmay-Kalos 2001).
/// The integral over co of everything equals `specular_albedo(ci)`.
class StackModel {
public:
    virtual ~StackModel() = default;

    /// Share of the flux from air direction cos_theta that arrives at the substrate. Under
    /// weidlich-wilkie it depends on the other direction, too, unless all is smooth: this is then
    /// what absorption and films let through, which does not.
    virtual double transmission(double cos_theta) const = 0;
    /// Share r of diffusely emitted flux that comes back down to the substrate; 0 for
    /// weidlich-wilkie.
    double internal_reflectance() const { return internal_reflectance(0.0); }
    /// Returns the internal reflectance for an Oren-Nayar substrate of width sigma: light is
    /// emitted and counted with the weights of a separable form of it
    /// (host/layers/models/oren_nayar_substrate.h). sigma = 0 gives the value for diffuse emission.
    virtual double internal_reflectance(double sigma) const = 0;
    /// IOR n_k of the medium above the substrate (1 for a bare one).
    virtual double lowest_ior() const = 0;
    /// Share of the flux from cos_theta that leaves again without reaching the substrate, delta
    /// included.
    virtual double specular_albedo(double cos_theta) const = 0;

    /// Weight of the mirror direction, unit 1, from all but a conductor at the end of the stack.
    virtual double specular_delta(double cos_theta) const = 0;
    /// True when the top interface is rough (alpha and distribution of the first layer).
    virtual bool has_top_lobe() const = 0;
    /// Shapes of the lobes besides the top one.
    virtual const std::vector<LobeShape>& deeper_lobes() const = 0;
    /// Amplitude a >= 0 of a deeper lobe. Adding tabulates it so that the lobe carries the flux
    /// that its interface sends back; under weidlich-wilkie it is what absorption and films above
    /// the part let through.
    virtual double lobe_amplitude(int lobe, double cos_theta) const = 0;
    virtual double residual(double cos_theta) const = 0;
    /// 2 * integral residual(c) c dc; 0 when there is none.
    virtual double residual_average() const = 0;
    /// Energy lost to single scattering on the way (0 for `multiple`): directional-hemispherical
    /// share that is neither reflected, transmitted nor absorbed. Weidlich-wilkie does not know it.
    virtual double lost(double cos_theta) const = 0;
};

/// Returns why adding cannot do a stack, or nothing if it can: it knows no flakes, and an operator
/// of a rough interface for each wavelength of a film costs too much (about a second each).
std::optional<std::string> adding_refusal(const LayerStack& stack);

/// Returns model B (`adding`) of the stack above a diffuse substrate, whether or not the list holds
/// that. It is cheap for smooth clear stacks (closed form); for rough ones the interfaces'
/// scattering operators are computed once per (IOR ratio, distribution, alpha, scattering) and kept
/// in memory and in the disk cache; slabs that scatter take some 10 ms each. Thread-safe. Throws an
/// input Error for numbers out of range and for what adding cannot do.
std::shared_ptr<const StackModel> adding_transport(const StackElements& stack);

} // namespace reradiant
