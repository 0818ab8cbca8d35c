#include "host/layers/models/adding.h"

#include "host/layers/angular/angular_transport.h"
#include "host/layers/rough/specular_lobes.h"
#include "host/layers/smooth/smooth_transport.h"
#include "host/layers/stack/directions.h"
#include "host/layers/stack/stack_check.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/microfacet.h"
#include "kernels/scatter/oren_nayar_shape.h"
#include "reradiant/error.h"
#include "reradiant/stack_model.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <numbers>
#include <utility>

namespace reradiant {

using kernels::Vec3;
using std::numbers::pi;

namespace {

/// Cosines at the substrate of what the stack sends back.
const CosineNodes substrate_nodes(33);

/// Returns the stack without absorption; nothing where there is none.
StackElements without_absorption(std::span<const StackElement> stack) {
    StackElements clear(stack.begin(), stack.end());
    bool absorbs = false;
    for (StackElement& element : clear)
        if (auto* slab = std::get_if<SlabValues>(&element))
            absorbs |= std::exchange(slab->tau, 0.0) > 0.0;
    return absorbs ? clear : StackElements{};
}

/// The last transports of stacks that scatter, and of clear ones: a grey material asks for the same
/// one at every wavelength.
class RecentTransports {
public:
    std::shared_ptr<const AddingModel> find(std::span<const StackElement> stack) {
        const std::scoped_lock lock(mutex_);
        for (const auto& [known, transport] : recent_)
            if (std::ranges::equal(known, stack))
                return transport;
        return nullptr;
    }
    void remember(std::span<const StackElement> stack,
                  std::shared_ptr<const AddingModel> transport) {
        const std::scoped_lock lock(mutex_);
        recent_.emplace_front(StackElements(stack.begin(), stack.end()), std::move(transport));
        if (recent_.size() > 64)
            recent_.pop_back();
    }

private:
    std::mutex mutex_;
    std::deque<std::pair<StackElements, std::shared_ptr<const AddingModel>>> recent_;
};

std::shared_ptr<const AddingModel> transport_of(std::span<const StackElement> stack) {
    if (std::none_of(stack.begin(), stack.end(), scatters))
        return smooth_transport(stack);
    return angular_transport(stack);
}

std::shared_ptr<const AddingModel> shared_transport(std::span<const StackElement> stack) {
    static RecentTransports recent;
    if (auto known = recent.find(stack))
        return known;
    auto transport = transport_of(stack);
    recent.remember(stack, transport);
    return transport;
}

} // namespace

AddingModel::AddingModel(std::span<const StackElement> stack)
    : top_(stack.empty() ? SurfaceValues{} : *surface_of(stack.front())),
      lowest_ior_(reradiant::lowest_ior(stack)), breaks_in_air_(breaks_in_air(stack)),
      clear_stack_(without_absorption(stack)) {}

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

double AddingModel::internal_reflectance(double sigma) const {
    if (sigma == 0.0)
        return diffuse_reflectance();
    return separable_internal_reflectance(sigma, clear().separable(sigma), returned());
}

const AddingModel& AddingModel::clear() const {
    if (clear_stack_.empty())
        return *this;
    std::call_once(clear_made_, [this] { clear_ = shared_transport(clear_stack_); });
    return *clear_;
}

const Eigen::MatrixXd& AddingModel::returned() const {
    std::call_once(returned_made_, [this] { returned_ = returned_to_substrate(substrate_nodes); });
    return returned_;
}

SeparableOrenNayar AddingModel::separable(double sigma) const {
    return separable_oren_nayar(sigma, substrate_nodes, returned());
}

std::shared_ptr<const OrenNayarTables> AddingModel::oren_nayar_tables(double sigma) const {
    if (sigma == 0.0)
        return nullptr;
    if (!clear_stack_.empty())
        return clear().oren_nayar_tables(sigma);
    const std::scoped_lock lock(tables_mutex_);
    auto& tables = tables_[sigma];
    if (!tables)
        tables = make_tables(sigma);
    return tables;
}

std::shared_ptr<const OrenNayarTables> AddingModel::make_tables(double sigma) const {
    const auto spread = arrivals();
    const SeparableOrenNayar kernel = separable(sigma);
    OrenNayarTables tables;
    if (spread)
        tables.spread = spread->spread_values(sigma);
    for (std::size_t node = 0; node < SHAPE_COSINES; ++node) {
        const double arriving = kernels::fresnel_cos_transmitted(
            kernels::oren_nayar_node_cosine(static_cast<kernels::uint>(node)), lowest_ior_);
        double albedo = 0.0;
        for (Eigen::Index k = 0; k < substrate_nodes.size(); ++k) {
            const double c = substrate_nodes.cosine(k);
            albedo += kernel.arriving(k) * (spread ? spread->mean_value(node, sigma, c)
                                                   : oren_nayar_mean_value(sigma, arriving, c));
        }
        tables.albedo.push_back(static_cast<float>(albedo));
    }
    return std::make_shared<const OrenNayarTables>(std::move(tables));
}

double AddingModel::way_in(const Vec3& wi, const Vec3&) const {
    return transmission(wi.z);
}

OrenNayarWeights AddingModel::way_out(double sigma, const Vec3& wi, const Vec3& wo) const {
    const double n = lowest_ior_;
    const auto tables = oren_nayar_tables(sigma);
    const OrenNayarWeights weights = oren_nayar_weights({sigma, n, tables.get()}, wi, wo);
    const double out = transmission(wo.z) * std::numbers::inv_pi / (n * n);
    return {out * weights.first, out * weights.rest};
}

std::optional<OrenNayarWeights> AddingModel::whole_way_out(double sigma, double cos_i) const {
    const auto tables = oren_nayar_tables(sigma);
    return oren_nayar_hemispherical({sigma, lowest_ior_, tables.get()}, cos_i, breaks_in_air_,
                                    [&](double cos_o) { return transmission(cos_o); });
}

std::vector<LobeShape> AddingModel::lobes() const {
    std::vector<LobeShape> all;
    for (const LobeShape& lobe : deeper_lobes())
        if (!lobe.is_between_facets()) // the top lobe covers it
            all.push_back(lobe);
    if (has_top_lobe())
        all.push_back({top_.distribution, top_.alpha});
    return all;
}

double AddingModel::diffuse_scale() const {
    return 1.0 / (pi * lowest_ior_ * lowest_ior_);
}

namespace {

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
    // total reflection begins within a cell of such an interface's directions, not between two: of
    // thin sheets that absorb little the light that it guides is then off by a fifth
    for (std::size_t k = 1; stack.is_sheet() && k < stack.layers.size(); ++k)
        if (stack.layers[k].alpha > 0.0)
            return "adding does not know rough interfaces inside a sheet";
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
    return shared_transport(above);
}

std::shared_ptr<const StackModel> adding_transport(const StackElements& stack) {
    return adding_bsdf(stack);
}

} // namespace reradiant
