#include "host/measure/layered_bsdf.h"

#include "kernels/stack/layer_stack.h"
#include "reradiant/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

/// The cosine's least share: it finds what no lobe of its own covers.
constexpr double least_cosine = 0.1;

std::unique_ptr<SurfaceModel> surface_of(const LayerStack& stack, const SubstrateValues& substrate,
                                         const WavelengthGrid& bands, Model model) {
    if (model == Model::Adding)
        return adding_surface(stack, substrate, bands);
    if (model == Model::WeidlichWilkie)
        return weidlich_wilkie_surface(stack, substrate, bands);
    throw_input_error({}, std::string("a closed form was asked of the model ") + model_name(model),
                      "use adding or weidlich-wilkie; the walk has functions of its own");
}

} // namespace

LayeredBsdf::LayeredBsdf(const LayerStack& stack, const SubstrateValues& substrate,
                         const WavelengthGrid& bands, Model model)
    : surface_(surface_of(stack, substrate, bands, model)), lobes_(surface_->lobes()),
      bands_(bands.count) {
    for (int node = 0; node < nodes; ++node) {
        const double u = static_cast<double>(node) / (nodes - 1);
        // at grazing light itself nothing is transported
        choices_[static_cast<std::size_t>(node)] = choice_at_node(std::max(u * u, 1e-4));
    }
}

/// Shares of the light, means over the bands of what each emits under white light.
LayeredBsdf::Choice LayeredBsdf::choice_at_node(double cos_theta) const {
    double mirror = 0.0, lobes = 0.0, cosine = 0.0;
    const Eigen::VectorXd diffuse = surface_->hemispherical_diffuse(cos_theta).rowwise().sum();
    for (int band = 0; band < bands_; ++band) {
        const double specular_delta = surface_->specular_delta(band, cos_theta);
        const double substrate_delta = surface_->substrate_delta(band, cos_theta);
        mirror += specular_delta + substrate_delta;
        lobes += surface_->hemispherical_specular(band, cos_theta) - specular_delta;
        (surface_->has_conductor() ? lobes : cosine) += diffuse(band) - substrate_delta;
    }
    if (lobes_.empty()) {
        cosine += lobes;
        lobes = 0.0;
    }
    const double sum = mirror + lobes + cosine;
    if (!(sum > 0.0))
        return {};
    const double rest = 1.0 - least_cosine;
    const double count = std::max<double>(1.0, static_cast<double>(lobes_.size()));
    return {rest * mirror / sum, least_cosine + rest * cosine / sum, rest * lobes / (sum * count)};
}

LayeredBsdf::Choice LayeredBsdf::choice(double cos_theta) const {
    const double x = std::sqrt(std::clamp(cos_theta, 0.0, 1.0)) * (nodes - 1);
    const int node = std::min(static_cast<int>(x), nodes - 2);
    const double t = x - node;
    const Choice& a = choices_[static_cast<std::size_t>(node)];
    const Choice& b = choices_[static_cast<std::size_t>(node) + 1];
    return {std::lerp(a.mirror, b.mirror, t), std::lerp(a.cosine, b.cosine, t),
            std::lerp(a.lobe, b.lobe, t)};
}

Eigen::MatrixXd LayeredBsdf::eval(const Vec3& wi, const Vec3& wo) const {
    if (!(wi.z > 0.0) || !(wo.z > 0.0))
        return Eigen::MatrixXd::Zero(bands_, bands_);
    Eigen::MatrixXd f = surface_->diffuse(wi, wo);
    for (int band = 0; band < bands_; ++band)
        f(band, band) += surface_->specular(band, wi, wo);
    return f;
}

Eigen::VectorXd LayeredBsdf::delta(double cos_theta) const {
    Eigen::VectorXd weight(bands_);
    for (int band = 0; band < bands_; ++band) {
        weight(band) =
            surface_->specular_delta(band, cos_theta) + surface_->substrate_delta(band, cos_theta);
    }
    return weight;
}

LayeredBsdf::Sample LayeredBsdf::sample(const Vec3& w, const std::array<double, 3>& random) const {
    const Choice chosen = choice(w.z);
    if (random[0] < chosen.mirror)
        return {kernels::vec3(-w.x, -w.y, w.z), chosen.mirror, true};
    double bound = chosen.mirror;
    for (const AddingTransport::Lobe& lobe : lobes_) {
        bound += chosen.lobe;
        if (random[0] < bound) {
            const Vec3 other = kernels::layer_stack_sample_lobe(
                kernel_distribution(lobe.distribution), lobe.alpha, w, random[1], random[2]);
            return {other, pdf(w, other), false};
        }
    }
    const Vec3 other = kernels::sampling_cosine(random[1], random[2]);
    return {other, pdf(w, other), false};
}

double LayeredBsdf::pdf(const Vec3& w, const Vec3& other) const {
    if (!(w.z > 0.0) || !(other.z > 0.0))
        return 0.0;
    const Choice chosen = choice(w.z);
    double sum = chosen.cosine * other.z * std::numbers::inv_pi;
    for (const AddingTransport::Lobe& lobe : lobes_) {
        sum += chosen.lobe * kernels::layer_stack_lobe_pdf(kernel_distribution(lobe.distribution),
                                                           lobe.alpha, w, other);
    }
    return sum;
}

} // namespace reradiant
