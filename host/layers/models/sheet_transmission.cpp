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

SheetTransmission::SheetTransmission(const StackElements& sheet,
                                     std::shared_ptr<const ThroughLobe> lobe)
    : lobe_(std::move(lobe)), whole_(sides_of(sheet)),
      scatters_(std::any_of(sheet.begin(), sheet.end(), slab_scatters)) {
    const StackElements unscattered = without_scattered(sheet);
    unscattered_ = scatters_ ? sides_of(unscattered) : whole_;
    if (!lobe_) {
        smooth_ = unscattered;
    } else {
        tables_ = fit_lobes({lobe_->above, lobe_->below},
                            {[&](double c) { return specular_albedo(c, Side::Above); },
                             [&](double c) { return specular_albedo(c, Side::Below); }});
        average_beside_ = average([&](double c) { return beside_lobe(c, Side::Above); });
    }
    if (scatters_)
        average_scattered_ = average([&](double c) { return scattered_albedo(c, Side::Above); });
}

double SheetTransmission::delta(double cos_theta) const {
    if (has_lobe())
        return 0.0;
    return smooth_response(smooth_pile(1.0, smooth_), 1.0, std::clamp(cos_theta, 0.0, 1.0))
        .transmission;
}

double SheetTransmission::specular_albedo(double cos_theta, Side from) const {
    return has_lobe() ? unscattered(from).transmission(cos_theta) : delta(cos_theta);
}

double SheetTransmission::scattered_albedo(double cos_theta, Side from) const {
    if (!scatters_)
        return 0.0;
    return std::max(whole(from).transmission(cos_theta) - specular_albedo(cos_theta, from), 0.0);
}

double SheetTransmission::beside_lobe(double cos_theta, Side from) const {
    if (!has_lobe())
        return 0.0;
    return std::max(specular_albedo(cos_theta, from) - lobe_albedo(cos_theta, from), 0.0);
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
    const double lobe = lobe_amplitude(above.z, Side::Above) *
                        lobe_amplitude(below_mirrored.z, Side::Below) *
                        lobe_value(lobe_->above, above, below_mirrored);
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
