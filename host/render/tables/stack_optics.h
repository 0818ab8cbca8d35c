#pragma once

#include "host/layers/models/sheet_transmission.h"
#include "host/layers/models/stack_bsdf.h"
#include "host/render/tables/lane_tables.h"
#include "reradiant/scene.h"

#include <deque>
#include <memory>
#include <vector>

namespace reradiant {

/// Wavelength at which spectra are read that a render takes at one wavelength only.
inline constexpr double reference_nm = 550.0;

/// A closed model of a material at every phase and lane of a plan, or once where nothing about it
/// depends on wavelength. A sheet is seen from a side.
class MaterialOptics {
public:
    MaterialOptics(const Material& material, Model model, const WavelengthPlan& plan);
    /// Takes those of `recent`, newest first, where one is of the same stacks: variants of a
    /// material whose textures colour the substrate are. This one becomes the newest of them.
    MaterialOptics(const Material& material, Model model, const WavelengthPlan& plan,
                   std::deque<MaterialOptics>& recent);
    /// The same sheet from the other side.
    MaterialOptics seen_from(Side side) const;

    bool is_spectral() const { return spectral_; }
    bool is_sheet() const { return !sheets_.empty(); }
    Side side() const { return side_; }
    const StackBsdf& at(int phase, int lane) const { return model(index(phase, lane)); }
    const StackBsdf& any() const { return model(0); }
    /// What goes through a sheet.
    const SheetTransmission& sheet_at(int phase, int lane) const {
        return *sheets_[index(phase, lane)];
    }
    const SheetTransmission& any_sheet() const { return *sheets_.front(); }

private:
    void make(bool is_sheet);
    std::size_t index(int phase, int lane) const {
        return spectral_ ? static_cast<std::size_t>(phase * lanes_ + lane) : 0;
    }
    const StackBsdf& model(std::size_t index) const {
        return is_sheet() ? sheets_[index]->whole(side_) : *optics_[index];
    }

    bool spectral_;
    int lanes_;
    Model model_;
    Side side_ = Side::Above;
    std::shared_ptr<const std::vector<StackElements>> stacks_; ///< [phase][lane], or one
    std::vector<std::shared_ptr<const StackBsdf>> optics_;     ///< empty for a sheet
    std::vector<std::shared_ptr<const SheetTransmission>> sheets_;
};

/// Returns true when something that the tables by the angle hold depends on wavelength.
bool depends_on_wavelength(const Material& material);

/// Returns true where adding has a lobe of the light that the facets of the top interface scatter
/// more than once, with a table of its own.
bool has_facet_lobe(const StackElements& stack);

/// Number of lobes of deeper interfaces that have a table (host/layers/models/returned_lobe.h)
/// under adding.
std::size_t returned_ratio_count(const StackElements& stack);

/// Number of rough lobes besides the top one that a material can have under a model.
int deeper_lobe_count(const Material& material, Model model);

} // namespace reradiant
