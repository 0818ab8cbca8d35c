#include "host/render/tables/stack_optics.h"

#include "host/render/tables/stack_parts.h"
#include "host/render/tables/weidlich_wilkie_optics.h"
#include "kernels/core/shared.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

using std::numbers::pi;

class AddingOptics final : public StackOptics {
public:
    explicit AddingOptics(std::shared_ptr<const AddingTransport> transport)
        : transport_(std::move(transport)),
          residual_scale_(transport_->residual_average() > 0.0
                              ? 1.0 / std::sqrt(pi * transport_->residual_average())
                              : 0.0) {}

    double transmission(double c) const override { return transport_->transmission(c); }
    double delta(double c) const override { return transport_->specular_delta(c); }
    double residual(double c) const override { return residual_scale_ * transport_->residual(c); }
    double amplitude(int lobe, double c) const override {
        return transport_->lobe_amplitude(lobe, c);
    }
    /// Returns shares that go with the squares of the amplitudes and add up to what neither delta
    /// nor residual reflects.
    std::vector<double> lobe_shares(double c) const override {
        std::vector<double> shares{transport_->has_top_lobe() ? 1.0 : 0.0};
        const auto lobes = static_cast<int>(deeper_lobes().size());
        for (int l = 0; l < lobes; ++l)
            shares.push_back(amplitude(l, c) * amplitude(l, c));
        double sum = 0.0;
        for (const double share : shares)
            sum += share;
        const double all =
            std::max(0.0, transport_->specular_albedo(c) - transport_->specular_delta(c) -
                              transport_->residual(c));
        for (double& share : shares)
            share *= sum > 0.0 ? all / sum : 0.0;
        return shares;
    }
    double internal_reflectance(double sigma) const override {
        return transport_->internal_reflectance(sigma);
    }
    double diffuse_scale() const override {
        return 1.0 / (pi * transport_->lowest_ior() * transport_->lowest_ior());
    }
    const std::vector<AddingTransport::Lobe>& deeper_lobes() const override {
        return transport_->deeper_lobes();
    }

private:
    std::shared_ptr<const AddingTransport> transport_;
    double residual_scale_;
};

/// Lobes beneath the top one that adding makes at most: one for each rough interface and for each
/// run of smooth ones beneath a rough one.
int adding_lobe_count(const LayerStack& stack) {
    int count = 0;
    bool below_rough = false, in_run = false;
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        const bool rough = stack.layers[k].alpha > 0.0;
        if (k > 0 && (rough || (below_rough && !in_run)))
            ++count;
        below_rough = below_rough || rough;
        in_run = below_rough && !rough;
    }
    return count;
}

} // namespace

bool depends_on_wavelength(const Material& material) {
    const Conductor& metal = material.substrate.conductor;
    return !material.stack.is_constant() ||
           (material.substrate.type == SubstrateType::Conductor &&
            !(metal.ior.is_constant() && metal.kappa.is_constant() && !metal.film));
}

int deeper_lobe_count(const Material& material, Model model) {
    return model == Model::WeidlichWilkie ? static_cast<int>(weidlich_wilkie_lobes(material).size())
                                          : adding_lobe_count(material.stack);
}

std::unique_ptr<StackOptics> stack_optics(const Material& material, Model model,
                                          double wavelength_nm) {
    if (model == Model::WeidlichWilkie)
        return weidlich_wilkie_optics(material, wavelength_nm);
    return std::make_unique<AddingOptics>(
        adding_transport(stack_at(material.stack, wavelength_nm)));
}

MaterialOptics::MaterialOptics(const Material& material, Model model, const WavelengthPlan& plan)
    : spectral_(depends_on_wavelength(material)), lanes_(static_cast<int>(plan.lanes.size())) {
    const int count = spectral_ ? plan.phases * lanes_ : 1;
    optics_.resize(static_cast<std::size_t>(count));
    tbb::parallel_for(0, count, [&](int i) {
        const double wavelength =
            spectral_ ? plan.wavelength_nm(i % lanes_, i / lanes_) : reference_nm;
        optics_[static_cast<std::size_t>(i)] = stack_optics(material, model, wavelength);
    });
}

} // namespace reradiant
