#include "host/layers/models/layered_bsdf.h"

#include "host/layers/rough/specular_lobes.h"
#include "kernels/core/sampling.h"
#include "kernels/stack/layer_stack.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

/// The cosine's least share: it finds what no lobe of its own covers.
constexpr double least_cosine = 0.1;

} // namespace

struct LayeredBsdf::Choices {
    static constexpr int nodes = 9;
    std::array<std::once_flag, 2> made; ///< by side
    std::array<std::array<Choice, nodes>, 2> at_node;
};

std::shared_ptr<LayeredBsdf::Choices> LayeredBsdf::new_choices() {
    return std::make_shared<Choices>();
}

const LobeShape* LayeredBsdf::far_lobe(Side from) const {
    const SheetTransmission* sheet =
        is_sheet() ? sheets_[static_cast<std::size_t>(bands() / 2)].get() : nullptr;
    return sheet && sheet->has_lobe() ? &sheet->lobe(from) : nullptr;
}

/// Shares of the light, means over the bands of what each emits under white light.
LayeredBsdf::Choice LayeredBsdf::choice_at_node(const AirDirection& from) const {
    const double c = from.cosine;
    const Parts near = albedo(from, from.side);
    double mirror = delta(c, from.side).sum();
    double conductor = 0.0;
    for (int band = 0; band < bands(); ++band)
        conductor += whole(band, from.side).conductor_delta(c);
    double lobes = near.specular.sum() - (mirror - conductor);
    double cosine = near.slab.sum() + (has_conductor_ ? 0.0 : near.diffuse.sum());
    if (has_conductor_)
        lobes += near.diffuse.sum() - conductor;
    double straight = 0.0, far_lobe_share = 0.0, far_cosine = 0.0;
    if (is_sheet()) {
        const Parts far = albedo(from, opposite(from.side));
        straight = straight_on(c).sum();
        far_lobe_share = std::max(far.specular.sum() - straight, 0.0);
        far_cosine = far.slab.sum() + 0.1 * far_lobe_share; // what no amplitude brings
    }
    const std::vector<LobeShape>& shapes = lobes_[from.side == Side::Above ? 0 : 1];
    if (shapes.empty()) {
        cosine += lobes;
        lobes = 0.0;
    }
    const double sum = mirror + lobes + cosine + straight + far_lobe_share + far_cosine;
    if (!(sum > 0.0))
        return {};
    const double least_far = is_sheet() ? least_cosine : 0.0;
    const double rest = (1.0 - least_cosine - least_far) / sum;
    const double count = std::max<double>(1.0, static_cast<double>(shapes.size()));
    return {rest * mirror,   least_cosine + rest * cosine,  rest * lobes / count,
            rest * straight, least_far + rest * far_cosine, rest * far_lobe_share};
}

LayeredBsdf::Choice LayeredBsdf::choice(const AirDirection& from) const {
    constexpr int nodes = Choices::nodes;
    const std::size_t side = from.side == Side::Above ? 0 : 1;
    std::call_once(choices_->made[side], [&] {
        for (int node = 0; node < nodes; ++node) {
            const double u = static_cast<double>(node) / (nodes - 1);
            // at grazing light itself nothing is transported
            choices_->at_node[side][static_cast<std::size_t>(node)] =
                choice_at_node({std::max(u * u, 1e-4), from.side});
        }
    });
    const double x = std::sqrt(std::clamp(from.cosine, 0.0, 1.0)) * (nodes - 1);
    const int node = std::min(static_cast<int>(x), nodes - 2);
    const double t = x - node;
    const Choice& a = choices_->at_node[side][static_cast<std::size_t>(node)];
    const Choice& b = choices_->at_node[side][static_cast<std::size_t>(node) + 1];
    return {std::lerp(a.mirror, b.mirror, t),
            std::lerp(a.cosine, b.cosine, t),
            std::lerp(a.lobe, b.lobe, t),
            std::lerp(a.straight, b.straight, t),
            std::lerp(a.far_cosine, b.far_cosine, t),
            std::lerp(a.far_lobe, b.far_lobe, t)};
}

namespace {

/// A direction found above, as it lies seen from w's side, on that side or on the other one. Of a
/// sheet, one that was found below lies in the surface: nothing goes on there.
Vec3 on_side_of(const Vec3& w, const Vec3& found, bool same, bool is_sheet) {
    const bool above = (w.z > 0.0) == same;
    const double z = is_sheet ? std::max(found.z, 0.0) : found.z;
    return kernels::vec3(found.x, found.y, above ? z : -z);
}

} // namespace

LayeredBsdf::Sample LayeredBsdf::sample(const Vec3& w, const std::array<double, 3>& random) const {
    const Choice chosen = choice(air_direction(w));
    const Vec3 own = mirrored_above(w);
    if (random[0] < chosen.mirror)
        return {kernels::vec3(-w.x, -w.y, w.z), chosen.mirror, true};
    double bound = chosen.mirror;
    for (const LobeShape& lobe : lobes_[w.z > 0.0 ? 0 : 1]) {
        bound += chosen.lobe;
        if (random[0] < bound) {
            const Vec3 other =
                on_side_of(w,
                           kernels::layer_stack_sample_lobe(kernel_distribution(lobe.distribution),
                                                            sampling_width(lobe, own.z), own,
                                                            random[1], random[2]),
                           true, is_sheet());
            return {other, pdf(w, other), false};
        }
    }
    bound += chosen.cosine;
    if (is_sheet() && !(random[0] < bound))
        return sample_far(w, chosen, random[0] - bound, random);
    const Vec3 other =
        on_side_of(w, kernels::sampling_cosine(random[1], random[2]), true, is_sheet());
    return {other, pdf(w, other), false};
}

/// `beyond`: how far the number that chooses lies in what is left for the far side.
LayeredBsdf::Sample LayeredBsdf::sample_far(const Vec3& w, const Choice& chosen, double beyond,
                                            const std::array<double, 3>& random) const {
    if (beyond < chosen.straight)
        return {kernels::vec3(-w.x, -w.y, -w.z), chosen.straight, true};
    Vec3 found = kernels::sampling_cosine(random[1], random[2]);
    const LobeShape* lobe = far_lobe(side_of(w));
    if (lobe && beyond < chosen.straight + chosen.far_lobe) {
        const Vec3 own = mirrored_above(w);
        found = kernels::layer_stack_sample_lobe(kernel_distribution(lobe->distribution),
                                                 sampling_width(*lobe, own.z), own, random[1],
                                                 random[2]);
    }
    const Vec3 other = on_side_of(w, found, false, true);
    return {other, pdf(w, other), false};
}

double LayeredBsdf::pdf(const Vec3& w, const Vec3& other) const {
    const bool same = (w.z > 0.0) == (other.z > 0.0);
    if (w.z == 0.0 || other.z == 0.0 || (!is_sheet() && !(w.z > 0.0 && same)))
        return 0.0;
    const Choice chosen = choice(air_direction(w));
    const Vec3 own = mirrored_above(w), found = mirrored_above(other);
    const auto lobe_pdf = [&](const LobeShape& lobe) {
        return kernels::layer_stack_lobe_pdf(kernel_distribution(lobe.distribution),
                                             sampling_width(lobe, own.z), own, found);
    };
    if (!same) {
        const LobeShape* lobe = far_lobe(side_of(w));
        return chosen.far_cosine * found.z * std::numbers::inv_pi +
               (lobe ? chosen.far_lobe * lobe_pdf(*lobe) : 0.0);
    }
    double sum = chosen.cosine * found.z * std::numbers::inv_pi;
    for (const LobeShape& lobe : lobes_[w.z > 0.0 ? 0 : 1])
        sum += chosen.lobe * lobe_pdf(lobe);
    return sum;
}

} // namespace reradiant
