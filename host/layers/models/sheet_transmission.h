#pragma once

#include "host/layers/models/stack_bsdf.h"
#include "host/layers/models/through_lobe.h"
#include "host/layers/stack/side.h"

#include <array>
#include <memory>

namespace reradiant {

/// Light that goes through a sheet in air at one wavelength without being absorbed (model adding):
/// the delta of smooth faces, a lobe of rough ones, and what slabs scatter.
///
/// The lobe has the shape of ThroughLobe. What slabs scatter, and what is left of the lobe's flux,
/// has a product form, t(above) t(below) / (pi average), as the residual of the light that comes
/// back has (reradiant/stack_model.h). Both are reciprocal between the sides and carry the flux
/// that adding gives them.
class SheetTransmission {
public:
    /// `lobe`: that of the sheet (through_lobe) at a wavelength that stands for all.
    SheetTransmission(const StackElements& sheet, std::shared_ptr<const ThroughLobe> lobe);

    /// The sheet as seen from a side, and without what its slabs scatter.
    const StackBsdf& whole(Side side) const { return *whole_[index(side)]; }
    const StackBsdf& unscattered(Side side) const { return *unscattered_[index(side)]; }

    /// Weight of the direction straight on, unit 1; the same from both sides.
    double delta(double cos_theta) const;
    /// Share of the flux from a side that goes through without being scattered in slabs, delta
    /// included, and of that which they scatter.
    double specular_albedo(double cos_theta, Side from) const;
    double scattered_albedo(double cos_theta, Side from) const;
    /// Values without deltas, 1/sr without the cosine, between a direction above and one below,
    /// which is given by its mirror image above.
    double specular(const kernels::Vec3& above, const kernels::Vec3& below_mirrored) const;
    double scattered(double cos_above, double cos_below) const;

    /// True where a face is rough: there is a lobe and no delta.
    bool has_lobe() const { return lobe_ != nullptr; }
    /// The lobe as seen from a side.
    const LobeShape& lobe(Side from) const {
        return from == Side::Above ? lobe_->above : lobe_->below;
    }
    /// Amplitude of the lobe: those of both sides multiply it.
    double lobe_amplitude(double cos_theta, Side side) const {
        return tables_[index(side)].amplitude(cos_theta);
    }
    /// Approximate share of the flux from a side that the lobe holds.
    double lobe_albedo(double cos_theta, Side from) const {
        return tables_[index(from)].albedo(cos_theta);
    }
    /// t of a side over sqrt(pi average): the product of both sides' is the product form's value.
    double product_amplitude(double cos_theta, Side side) const;

private:
    using Sides = std::array<std::shared_ptr<const StackBsdf>, 2>;

    static std::size_t index(Side side) { return side == Side::Above ? 0 : 1; }
    static Sides sides_of(const StackElements& sheet);
    /// Share of the lobe's flux that no amplitude brings.
    double beside_lobe(double cos_theta, Side from) const;
    double product(double cos_above, double cos_below) const;

    std::shared_ptr<const ThroughLobe> lobe_;
    StackElements smooth_; ///< without scattering; empty where a face is rough
    Sides whole_, unscattered_;
    bool scatters_ = false;
    std::array<LobeTables, 2> tables_; ///< of the lobe, by side
    double average_beside_ = 0.0, average_scattered_ = 0.0;
};

} // namespace reradiant
