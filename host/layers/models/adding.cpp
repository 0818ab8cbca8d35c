#include "host/layers/models/adding.h"

#include "host/layers/angular/angular_transport.h"
#include "host/layers/rough/specular_lobes.h"
#include "host/layers/smooth/smooth_transport.h"
#include "host/layers/stack/directions.h"
#include "host/layers/stack/stack_check.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/microfacet.h"
#include "reradiant/error.h"
#include "reradiant/stack_model.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <numbers>

namespace reradiant {

using kernels::Vec3;
using std::numbers::pi;

AddingModel::AddingModel(std::span<const StackElement> stack)
    : top_(stack.empty() ? SurfaceValues{} : *surface_of(stack.front())),
      lowest_ior_(reradiant::lowest_ior(stack)), breaks_in_air_(breaks_in_air(stack)) {}

double AddingModel::top_lobe(const Vec3& wi, const Vec3& wo) const {
    const Vec3 h = kernels::vec3_normalise(kernels::vec3_add(wi, wo));
    return kernels::fresnel_dielectric(kernels::vec3_dot(wi, h), top_.ior_below) *
           kernels::microfacet_reflection(kernel_distribution(top_.distribution), top_.alpha, wi,
                                          wo);
}

double AddingModel::specular(const Vec3& wi, const Vec3& wo) const {
    double sum = has_top_lobe() ? top_lobe(wi, wo) : 0.0;
    const std::vector<LobeShape>& shapes = deeper_lobes();
    for (std::size_t l = 0; l < shapes.size(); ++l) {
        const int index = static_cast<int>(l);
        sum += lobe_amplitude(index, wi.z) * lobe_amplitude(index, wo.z) *
               lobe_value(shapes[l], wi, wo);
    }
    if (residual_average() > 0.0)
        sum += residual(wi.z) * residual(wo.z) * std::numbers::inv_pi / residual_average();
    return sum;
}

double AddingModel::way_in(const Vec3& wi, const Vec3&) const {
    return transmission(wi.z);
}

OrenNayarWeights AddingModel::way_out(double sigma, const Vec3& wi, const Vec3& wo) const {
    const double n = lowest_ior_;
    const OrenNayarWeights weights = oren_nayar_weights(sigma, n, wi, wo);
    const double out = transmission(wo.z) * std::numbers::inv_pi / (n * n);
    return {out * weights.first, out * weights.rest};
}

std::optional<OrenNayarWeights> AddingModel::whole_way_out(double sigma, double cos_i) const {
    return oren_nayar_hemispherical(sigma, lowest_ior_, cos_i, breaks_in_air_,
                                    [&](double cos_o) { return transmission(cos_o); });
}

std::vector<LobeShape> AddingModel::lobes() const {
    std::vector<LobeShape> all;
    for (const LobeShape& lobe : deeper_lobes())
        if (!lobe.table) // the top lobe covers it
            all.push_back(lobe);
    if (has_top_lobe())
        all.push_back({top_.distribution, top_.alpha});
    return all;
}

double AddingModel::diffuse_scale() const {
    return 1.0 / (pi * lowest_ior_ * lowest_ior_);
}

namespace {

/// The last transports of stacks that scatter: a grey material asks for the same one at every
/// wavelength.
class RecentTransports {
public:
    std::shared_ptr<const StackBsdf> find(std::span<const StackElement> stack) {
        const std::scoped_lock lock(mutex_);
        for (const auto& [known, transport] : recent_)
            if (std::ranges::equal(known, stack))
                return transport;
        return nullptr;
    }
    void remember(std::span<const StackElement> stack, std::shared_ptr<const StackBsdf> transport) {
        const std::scoped_lock lock(mutex_);
        recent_.emplace_front(StackElements(stack.begin(), stack.end()), std::move(transport));
        if (recent_.size() > 64)
            recent_.pop_back();
    }

private:
    std::mutex mutex_;
    std::deque<std::pair<StackElements, std::shared_ptr<const StackBsdf>>> recent_;
};

constexpr const char* flakes_reason = "adding does not know flakes";
constexpr const char* film_reason = "adding does not know films on rough interfaces";
constexpr const char* conductor_reason = "adding does not know conductors";

/// Returns why adding cannot do an element; null if it can.
const char* refusal(const StackElement& element) {
    if (std::holds_alternative<FlakesValues>(element))
        return flakes_reason;
    const SurfaceValues* surface = surface_of(element);
    if (surface && surface->is_conductor)
        return conductor_reason;
    return surface && surface->has_film() && surface->scatters() ? film_reason : nullptr;
}

} // namespace

std::optional<std::string> adding_refusal(const LayerStack& stack) {
    for (const Layer& layer : stack.layers) {
        if (layer.flakes && layer.flakes->coverage > 0.0)
            return flakes_reason;
        if (layer.film && layer.film->thickness_nm > 0.0 && layer.alpha > 0.0)
            return film_reason;
    }
    return std::nullopt;
}

std::shared_ptr<const StackBsdf> adding_bsdf(const StackElements& stack) {
    check_stack(stack);
    for (const StackElement& element : stack)
        if (const char* reason = refusal(element))
            throw_input_error({}, reason, "use the model walk or weidlich-wilkie");
    const std::span<const StackElement> above = above_substrate(stack);
    if (std::none_of(above.begin(), above.end(), scatters))
        return smooth_transport(above);
    static RecentTransports recent;
    if (auto known = recent.find(above))
        return known;
    auto transport = angular_transport(above);
    recent.remember(above, transport);
    return transport;
}

std::shared_ptr<const StackModel> adding_transport(const StackElements& stack) {
    return adding_bsdf(stack);
}

} // namespace reradiant
