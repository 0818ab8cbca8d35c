#include "host/layers/models/weidlich_wilkie_bsdf.h"

#include "host/layers/models/weidlich_wilkie.h"
#include "host/layers/models/weidlich_wilkie_residual.h"
#include "host/layers/rough/facet_reflectance.h"
#include "host/layers/stack/directions.h"
#include "host/layers/stack/lobe_quadrature.h"
#include "host/layers/stack/stack_check.h"
#include "kernels/scatter/fresnel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

/// A `StraightWay` follows light down from a direction in air by absorption and films alone.
struct StraightWay {
    double cosine, depth = 0.0, through_films = 1.0;

    void cross(const StackElement& element) {
        if (const auto* slab = std::get_if<SlabValues>(&element)) {
            if (slab->depth() > 0.0)
                depth += slab->depth() / cosine;
        } else if (const auto* surface = std::get_if<SurfaceValues>(&element)) {
            if (surface->has_film())
                through_films *= 1.0 - facet_reflectance(*surface, cosine);
            cosine =
                kernels::fresnel_cos_transmitted(cosine, surface->ior_below / surface->ior_above);
        }
    }
    double unabsorbed() const { return through_films * std::exp(-depth); }
};

class WeidlichWilkieBsdf final : public StackBsdf {
public:
    explicit WeidlichWilkieBsdf(const StackElements& stack)
        : stack_(stack), above_(above_substrate(stack_)), lobes_(weidlich_wilkie_lobes(stack)),
          all_smooth_(is_all_smooth(stack)), residual_(stack) {
        for (const DeeperLobe& lobe : lobes_) {
            const SurfaceValues* surface = surface_of(stack_[lobe.element]);
            shapes_.push_back(surface ? shape_in_air(*surface) : LobeShape{Distribution::Ggx, 1.0});
        }
    }

    double specular(const Vec3& wi, const Vec3& wo) const override {
        return WeidlichWilkie::specular(stack_, wi, wo) +
               (1.0 - conductor_share(wi.z)) * residual_.value(wi.z, wo.z);
    }
    double specular_delta(double c) const override {
        return WeidlichWilkie::specular_delta(stack_, c);
    }
    double specular_albedo(double c) const override;
    double conductor(const Vec3& wi, const Vec3& wo) const override {
        return WeidlichWilkie::conductor(stack_, wi, wo) +
               conductor_share(wi.z) * residual_.value(wi.z, wo.z);
    }
    double conductor_delta(double c) const override {
        return WeidlichWilkie::conductor_delta(stack_, c);
    }
    double conductor_albedo(double c) const override;
    double lost(double) const override { return 0.0; }

    double way_in(const Vec3& wi, const Vec3& wo) const override {
        return WeidlichWilkie::way_in(stack_, wi, wo);
    }
    OrenNayarWeights way_out(double sigma, const Vec3& wi, const Vec3& wo) const override {
        return {WeidlichWilkie::way_out(stack_, wi, wo) * std::numbers::inv_pi *
                    WeidlichWilkie::diffuse_shape(stack_, sigma, wi, wo),
                0.0};
    }
    double transmission(double c) const override {
        if (!all_smooth_)
            return way_to(above_.size(), c).unabsorbed();
        const Vec3 w = direction_at(c, 0.0);
        return c > 0.0 ? WeidlichWilkie::way_in(stack_, w, w) : 0.0;
    }
    double internal_reflectance(double) const override { return 0.0; }
    double lowest_ior() const override { return reradiant::lowest_ior(stack_); }
    double diffuse_scale() const override { return std::numbers::inv_pi; }

    double residual(double c) const override { return residual_(c); }
    double residual_average() const override { return residual_.average(); }
    bool has_top_lobe() const override { return !stack_.empty() && is_rough(stack_.front()); }
    const std::vector<LobeShape>& deeper_lobes() const override { return shapes_; }
    double lobe_amplitude(int lobe, double c) const override {
        return way_to(lobes_[static_cast<std::size_t>(lobe)].element, c).unabsorbed();
    }
    std::vector<LobeShape> lobes() const override;
    std::vector<double> lobe_shares(double c) const override {
        std::vector<double> shares{has_top_lobe() ? reflected(0, c) : 0.0};
        for (const DeeperLobe& lobe : lobes_)
            shares.push_back(surface_of(stack_[lobe.element]) ? reflected(lobe.element, c) : 0.0);
        return shares;
    }
    double scattered_share(double c) const override {
        double sum = 0.0;
        for (const DeeperLobe& lobe : lobes_)
            if (const auto* slab = std::get_if<SlabValues>(&stack_[lobe.element]))
                sum += scattered(*slab, way_to(lobe.element, c).unabsorbed());
        return sum;
    }

private:
    static bool is_rough(const StackElement& element) {
        const SurfaceValues* surface = surface_of(element);
        return surface && surface->alpha > 0.0;
    }
    /// A slope of the half vector in a medium is as many times as large in air as its IOR says.
    static LobeShape shape_in_air(const SurfaceValues& surface) {
        return {surface.distribution, std::min(1.0, surface.ior_above * surface.alpha)};
    }

    /// The residual is one reciprocal product for all parts; what of it met the conductor is its
    /// share in the light from wi, which keeps the hemispherical values exact.
    double conductor_share(double cos_i) const {
        const double whole = residual_(cos_i);
        return whole > 0.0 ? residual_.conductor_part(cos_i) / whole : 0.0;
    }

    StraightWay way_to(std::size_t element, double cosine) const {
        StraightWay way{cosine};
        for (std::size_t e = 0; e < element; ++e)
            way.cross(stack_[e]);
        return way;
    }

    /// Returns approximately what a part reflects through what lies above it, as if all were
    /// smooth.
    double reflected(std::size_t element, double cosine) const {
        const StraightWay end = way_to(element, cosine);
        double way = end.unabsorbed();
        StraightWay at{cosine};
        for (std::size_t e = 0; e < element; ++e) {
            const auto* surface = std::get_if<SurfaceValues>(&stack_[e]);
            if (surface && !surface->has_film())
                way *= 1.0 - facet_reflectance(*surface, at.cosine);
            else if (!surface && surface_of(stack_[e]))
                way *= 1.0 - coverage_of(stack_[e]);
            at.cross(stack_[e]);
        }
        return way * way * coverage_of(stack_[element]) *
               facet_reflectance(*surface_of(stack_[element]), end.cosine);
    }

    /// Returns approximately what a slab scatters up: half of what it takes out of the beam.
    static double scattered(const SlabValues& slab, double way) {
        const double tau = slab.depth();
        return tau > 0.0 ? -0.5 * way * way * slab.tau_scattering / tau * std::expm1(-2.0 * tau)
                         : 0.0;
    }

    StackElements stack_;
    std::span<const StackElement> above_; ///< the substrate
    std::vector<DeeperLobe> lobes_;
    std::vector<LobeShape> shapes_;
    bool all_smooth_;
    WeidlichWilkieResidual residual_;
};

std::vector<LobeShape> WeidlichWilkieBsdf::lobes() const {
    std::vector<LobeShape> all;
    for (const StackElement& element : stack_)
        if (is_rough(element))
            all.push_back(shape_in_air(*surface_of(element)));
    return all;
}

double WeidlichWilkieBsdf::specular_albedo(double c) const {
    double sum = specular_delta(c) + residual_(c) - residual_.conductor_part(c);
    const bool has_lobes =
        std::any_of(above_.begin(), above_.end(), [](const StackElement& element) {
            const auto* slab = std::get_if<SlabValues>(&element);
            return is_rough(element) || std::holds_alternative<FlakesValues>(element) ||
                   (slab && slab->scatters());
        });
    if (has_lobes) {
        const Vec3 wi = direction_at(c, 0.0);
        sum += integrate_about_mirror(
            wi, [&](const Vec3& wo) { return WeidlichWilkie::specular(stack_, wi, wo); });
    }
    return sum;
}

double WeidlichWilkieBsdf::conductor_albedo(double c) const {
    double sum = conductor_delta(c) + residual_.conductor_part(c);
    const SurfaceValues* conductor = conductor_of(stack_);
    if (conductor && conductor->alpha > 0.0) {
        const Vec3 wi = direction_at(c, 0.0);
        sum += integrate_about_mirror(
            wi, [&](const Vec3& wo) { return WeidlichWilkie::conductor(stack_, wi, wo); });
    }
    return sum;
}

} // namespace

std::shared_ptr<const StackBsdf> weidlich_wilkie_bsdf(const StackElements& stack) {
    check_stack(stack);
    return std::make_shared<WeidlichWilkieBsdf>(stack);
}

std::vector<DeeperLobe> weidlich_wilkie_lobes(const StackElements& stack) {
    std::vector<DeeperLobe> lobes;
    std::size_t part = 0;
    for (std::size_t e = 0; e < stack.size(); ++e) {
        if (const SurfaceValues* surface = surface_of(stack[e])) {
            if (part > 0 && surface->alpha > 0.0)
                lobes.push_back({e, part});
            ++part;
        } else if (const auto* slab = std::get_if<SlabValues>(&stack[e]); slab && slab->may_scatter)
            lobes.push_back({e, part});
    }
    return lobes;
}

bool is_all_smooth(const StackElements& stack) {
    return std::none_of(stack.begin(), stack.end(), [](const StackElement& element) {
        const SurfaceValues* surface = surface_of(element);
        const auto* slab = std::get_if<SlabValues>(&element);
        return (surface && surface->alpha > 0.0) || (slab && slab->may_scatter);
    });
}

} // namespace reradiant
