#include "host/layers/models/sheet_transmission.h"

#include "host/layers/models/adding.h"
#include "host/layers/smooth/smooth_stack.h"
#include "host/layers/stack/quadrature.h"
#include "host/layers/stack/stack_variants.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

bool slab_scatters(const StackElement& element) {
    return std::holds_alternative<SlabValues>(element) && scatters(element);
}

/// The lobe of light that goes through all rough interfaces once. A lobe's passages are made on the
/// way in and on the way out: half of each, by the terms that add up.
LobeShape lobe_through(std::span<const StackElement> sheet) {
    LobeShape lobe;
    for (const StackElement& element : sheet) {
        const auto* surface = std::get_if<SurfaceValues>(&element);
        if (!surface || !surface->scatters())
            continue;
        lobe.distribution = surface->distribution;
        const double power = surface->distribution == Distribution::Ggx ? 1.5 : 2.0;
        lobe.passages.push_back(
            {surface->alpha * std::pow(0.5, 1.0 / power), surface->ior_above, surface->ior_below});
    }
    lobe.ior = 1.0; // no facet of its own: alpha is 0
    return lobe;
}

/// Mean of a share over diffuse light.
template <typename Share>
double average(const Share& share) {
    constexpr int nodes = 48;
    return integrate_pieces({0.0, 1.0}, nodes, [&](double c) { return 2.0 * c * share(c); });
}

} // namespace

SheetTransmission::Sides SheetTransmission::sides_of(const StackElements& sheet) {
    return {adding_bsdf(sheet), adding_bsdf(upside_down(sheet))};
}

SheetTransmission::SheetTransmission(const StackElements& sheet)
    : whole_(sides_of(sheet)), scatters_(std::any_of(sheet.begin(), sheet.end(), slab_scatters)) {
    const StackElements unscattered = without_scattered(sheet);
    unscattered_ = scatters_ ? sides_of(unscattered) : whole_;
    if (std::none_of(sheet.begin(), sheet.end(), is_rough_interface)) {
        smooth_ = unscattered;
    } else {
        lobe_ = lobe_through(sheet);
        // no more than goes through from either side, whose averages are equal: what is left of
        // both has the product form
        tables_ = fit_lobe(lobe_, [&](double c) {
            return std::min(specular_albedo(c, Side::Above), specular_albedo(c, Side::Below));
        });
        average_beside_ = average([&](double c) { return beside_lobe(c, Side::Above); });
    }
    if (scatters_)
        average_scattered_ = average([&](double c) { return scattered_albedo(c, Side::Above); });
}

double SheetTransmission::delta(double cos_theta) const {
    if (smooth_.empty())
        return 0.0;
    return smooth_response(smooth_pile(1.0, smooth_), 1.0, std::clamp(cos_theta, 0.0, 1.0))
        .transmission;
}

double SheetTransmission::specular_albedo(double cos_theta, Side from) const {
    return smooth_.empty() ? unscattered(from).transmission(cos_theta) : delta(cos_theta);
}

double SheetTransmission::scattered_albedo(double cos_theta, Side from) const {
    if (!scatters_)
        return 0.0;
    return std::max(whole(from).transmission(cos_theta) - specular_albedo(cos_theta, from), 0.0);
}

double SheetTransmission::beside_lobe(double cos_theta, Side from) const {
    if (!has_lobe())
        return 0.0;
    return std::max(specular_albedo(cos_theta, from) - tables_.albedo(cos_theta), 0.0);
}

double SheetTransmission::product_amplitude(double cos_theta, Side side) const {
    const double average = average_beside_ + average_scattered_;
    if (!(average > 0.0))
        return 0.0;
    return (beside_lobe(cos_theta, side) + scattered_albedo(cos_theta, side)) /
           std::sqrt(std::numbers::pi * average);
}

double SheetTransmission::product(double cos_above, double cos_below) const {
    return product_amplitude(cos_above, Side::Above) * product_amplitude(cos_below, Side::Below);
}

double SheetTransmission::specular(const kernels::Vec3& above,
                                   const kernels::Vec3& below_mirrored) const {
    if (!has_lobe())
        return 0.0;
    const double lobe = lobe_amplitude(above.z) * lobe_amplitude(below_mirrored.z) *
                        lobe_value(lobe_, above, below_mirrored);
    const double beside = average_beside_ > 0.0
                              ? average_beside_ / (average_beside_ + average_scattered_) *
                                    product(above.z, below_mirrored.z)
                              : 0.0;
    return lobe + beside;
}

double SheetTransmission::scattered(double cos_above, double cos_below) const {
    if (!(average_scattered_ > 0.0))
        return 0.0;
    return average_scattered_ / (average_beside_ + average_scattered_) *
           product(cos_above, cos_below);
}

} // namespace reradiant
