#include "host/render/tables/weidlich_wilkie_optics.h"

#include "host/layers/models/weidlich_wilkie.h"
#include "host/layers/models/weidlich_wilkie_residual.h"
#include "host/render/tables/stack_parts.h"
#include "kernels/scatter/fresnel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace reradiant {

namespace {

class WeidlichWilkieOptics final : public StackOptics {
public:
    WeidlichWilkieOptics(const Material& material, double wavelength_nm)
        : parts_(stack_parts(material)), lobes_(weidlich_wilkie_lobes(material)),
          values_(material_at(material, wavelength_nm)), all_smooth_(is_all_smooth(material)),
          has_conductor_(material.substrate.type == SubstrateType::Conductor),
          residual_(values_.stack,
                    has_conductor_ ? std::optional(values_.conductor) : std::nullopt),
          residual_scale_(residual_.average() > 0.0
                              ? 1.0 / std::sqrt(std::numbers::pi * residual_.average())
                              : 0.0) {
        for (const DeeperLobe& lobe : lobes_)
            shapes_.push_back(lobe.is_slab ? AddingTransport::Lobe{Distribution::Ggx, 1.0}
                                           : shape_in_air(parts_[lobe.part]));
    }

    double transmission(double c) const override {
        if (!all_smooth_)
            return unabsorbed(values_.stack.size(), c);
        const kernels::Vec3 w = kernels::vec3(std::sqrt((1.0 - c) * (1.0 + c)), 0.0, c);
        return c > 0.0 ? WeidlichWilkie::way_in(values_.stack, w, w) : 0.0;
    }
    double delta(double c) const override {
        const double metal =
            has_conductor_ ? WeidlichWilkie::conductor_delta(values_.stack, values_.conductor, c)
                           : 0.0;
        return WeidlichWilkie::specular_delta(values_.stack, c) + metal;
    }
    double residual(double c) const override { return residual_scale_ * residual_(c); }
    double amplitude(int lobe, double c) const override {
        return unabsorbed(lobes_[static_cast<std::size_t>(lobe)].layer, c);
    }
    std::vector<double> lobe_shares(double c) const override {
        std::vector<double> shares{0.0};
        if (!parts_.empty() && parts_.front().alpha > 0.0)
            shares.front() = reflected(parts_.front(), c);
        for (const DeeperLobe& lobe : lobes_)
            shares.push_back(lobe.is_slab ? 0.0 : reflected(parts_[lobe.part], c));
        return shares;
    }
    double scattered_share(double c) const override {
        double sum = 0.0;
        for (const DeeperLobe& lobe : lobes_)
            sum += lobe.is_slab ? scattered(lobe, c) : 0.0;
        return sum;
    }
    double internal_reflectance(double) const override { return 0.0; }
    double diffuse_scale() const override { return std::numbers::inv_pi; }
    const std::vector<AddingTransport::Lobe>& deeper_lobes() const override { return shapes_; }

private:
    /// Half vectors in air are narrower than those inside by the IOR.
    AddingTransport::Lobe shape_in_air(const StackPart& part) const {
        return {part.distribution,
                std::min(1.0, values_.ior_below(part.slabs_above()) * part.alpha)};
    }

    /// Cosines in the air and in each slab of a direction in air.
    std::vector<double> cosines(double c) const {
        std::vector<double> all{c};
        for (std::size_t k = 0; k < values_.stack.size(); ++k)
            all.push_back(kernels::fresnel_cos_transmitted(all.back(), values_.ior_below(k + 1) /
                                                                           values_.ior_below(k)));
        return all;
    }

    double through_interface(std::size_t layer, double c) const {
        return 1.0 - values_.facet_reflectance({StackPart::Kind::Interface, layer}, c);
    }

    /// Returns the share of light that the first `count` slabs and the films above them let
    /// through, one way.
    double unabsorbed(std::size_t count, double cosine) const {
        const std::vector<double> c = cosines(cosine);
        double depth = 0.0, through_films = 1.0;
        for (std::size_t k = 0; k < count; ++k) {
            const LayerValues& layer = values_.stack[k];
            const double tau = layer.tau + layer.tau_scattering;
            if (tau > 0.0)
                depth += tau / c[k + 1];
            if (layer.film.thickness_nm > 0.0)
                through_films *= through_interface(k, c[k]);
        }
        return through_films * std::exp(-depth);
    }

    /// Returns approximately what a part reflects through what lies above it, as if all were
    /// smooth.
    double reflected(const StackPart& part, double cosine) const {
        const std::vector<double> c = cosines(cosine);
        double way = unabsorbed(part.slabs_above(), cosine);
        for (std::size_t k = 0; k < part.slabs_above(); ++k) {
            if (!(values_.stack[k].film.thickness_nm > 0.0))
                way *= through_interface(k, c[k]);
            if (k < part.layer)
                way *= 1.0 - values_.stack[k].flake_coverage;
        }
        const double coverage =
            part.kind == StackPart::Kind::Flakes ? values_.stack[part.layer].flake_coverage : 1.0;
        return way * way * coverage * values_.facet_reflectance(part, c[part.slabs_above()]);
    }

    /// Returns approximately what a slab scatters up: half of what it takes out of the beam.
    double scattered(const DeeperLobe& lobe, double cosine) const {
        const LayerValues& slab = values_.stack[lobe.layer];
        const double tau = slab.tau + slab.tau_scattering;
        const double way = unabsorbed(lobe.layer, cosine);
        return tau > 0.0 ? -0.5 * way * way * slab.tau_scattering / tau * std::expm1(-2.0 * tau)
                         : 0.0;
    }

    std::vector<StackPart> parts_;
    std::vector<DeeperLobe> lobes_;
    std::vector<AddingTransport::Lobe> shapes_;
    MaterialValues values_;
    bool all_smooth_, has_conductor_;
    WeidlichWilkieResidual residual_;
    double residual_scale_;
};

} // namespace

std::unique_ptr<StackOptics> weidlich_wilkie_optics(const Material& material,
                                                    double wavelength_nm) {
    return std::make_unique<WeidlichWilkieOptics>(material, wavelength_nm);
}

} // namespace reradiant
