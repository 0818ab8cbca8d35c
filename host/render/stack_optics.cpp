#include "host/render/stack_optics.h"

#include "host/layers/weidlich_wilkie.h"
#include "kernels/fresnel.h"

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
    double rough_share(double c) const override {
        return std::max(0.0, transport_->specular_albedo(c) - transport_->specular_delta(c) -
                                 transport_->residual(c));
    }
    double internal_reflectance() const override { return transport_->internal_reflectance(); }
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

/// Model A. Under rough interfaces its Fresnel and geometry factors depend on both directions and
/// are applied by the kernel (layer_stack.h); the tables then hold the absorption alone.
class WeidlichWilkieOptics final : public StackOptics {
public:
    WeidlichWilkieOptics(StackValues stack, std::vector<int> lobe_layers)
        : stack_(std::move(stack)), lobe_layers_(std::move(lobe_layers)) {
        smooth_ = std::all_of(stack_.begin(), stack_.end(),
                              [](const LayerValues& layer) { return layer.alpha == 0.0; });
        for (const int layer : lobe_layers_) {
            const LayerValues& values = stack_[static_cast<std::size_t>(layer)];
            const double above = layer > 0 ? stack_[static_cast<std::size_t>(layer - 1)].ior : 1.0;
            lobes_.push_back({values.distribution, std::min(1.0, above * values.alpha)});
        }
    }

    double transmission(double c) const override {
        if (!smooth_)
            return absorbed(stack_.size(), c);
        const kernels::Vec3 w = kernels::vec3(std::sqrt((1.0 - c) * (1.0 + c)), 0.0, c);
        return c > 0.0 ? WeidlichWilkie::way_in(stack_, w, w) : 0.0;
    }
    double delta(double c) const override { return WeidlichWilkie::specular_delta(stack_, c); }
    double residual(double) const override { return 0.0; }
    double amplitude(int lobe, double c) const override {
        return absorbed(static_cast<std::size_t>(lobe_layers_[static_cast<std::size_t>(lobe)]), c);
    }
    double rough_share(double c) const override {
        return smooth_ ? 0.0 : kernels::fresnel_dielectric(c, stack_.front().ior);
    }
    double internal_reflectance() const override { return 0.0; }
    double diffuse_scale() const override { return 1.0 / pi; }
    const std::vector<AddingTransport::Lobe>& deeper_lobes() const override { return lobes_; }

private:
    /// Absorption of the first `count` slabs, one way.
    double absorbed(std::size_t count, double c) const {
        double depth = 0.0, ior = 1.0;
        for (std::size_t k = 0; k < count; ++k) {
            c = kernels::fresnel_cos_transmitted(c, stack_[k].ior / ior);
            ior = stack_[k].ior;
            if (stack_[k].tau > 0.0)
                depth += stack_[k].tau / c;
        }
        return std::exp(-depth);
    }

    StackValues stack_;
    std::vector<int> lobe_layers_;
    std::vector<AddingTransport::Lobe> lobes_;
    bool smooth_ = true;
};

} // namespace

std::vector<int> deeper_lobe_layers(const LayerStack& stack) {
    std::vector<int> layers;
    bool below_rough = false;
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        const bool rough = stack.layers[k].alpha > 0.0;
        if (k > 0 && (rough || below_rough))
            layers.push_back(static_cast<int>(k));
        below_rough |= rough;
    }
    return layers;
}

std::unique_ptr<StackOptics> stack_optics(const LayerStack& stack, Model model,
                                          double wavelength_nm) {
    const StackValues values = stack_at(stack, wavelength_nm);
    if (model != Model::WeidlichWilkie)
        return std::make_unique<AddingOptics>(adding_transport(values));
    std::vector<int> lobes = deeper_lobe_layers(stack);
    std::erase_if(lobes, [&](int k) {
        return stack.layers[static_cast<std::size_t>(k)].alpha == 0.0; // part of the delta
    });
    return std::make_unique<WeidlichWilkieOptics>(values, std::move(lobes));
}

} // namespace reradiant
