#pragma once

#include "host/layers/models/stack_bsdf.h"
#include "host/render/tables/lane_tables.h"
#include "reradiant/scene.h"

#include <memory>
#include <vector>

namespace reradiant {

/// Wavelength at which spectra are read that a render takes at one wavelength only.
inline constexpr double reference_nm = 550.0;

/// A closed model of a material at every phase and lane of a plan, or once where nothing about it
/// depends on wavelength.
class MaterialOptics {
public:
    MaterialOptics(const Material& material, Model model, const WavelengthPlan& plan);

    bool is_spectral() const { return spectral_; }
    const StackBsdf& at(int phase, int lane) const {
        return *optics_[spectral_ ? static_cast<std::size_t>(phase * lanes_ + lane) : 0];
    }
    const StackBsdf& any() const { return *optics_.front(); }

private:
    bool spectral_;
    int lanes_;
    std::vector<std::shared_ptr<const StackBsdf>> optics_;
};

/// Returns true when something that the tables by the angle hold depends on wavelength.
bool depends_on_wavelength(const Material& material);

/// Returns true where adding has a lobe of the light that the facets of the top interface scatter
/// more than once, with a table of its own.
bool has_facet_lobe(const LayerStack& stack);

/// Number of rough lobes besides the top one that a material can have under a model.
int deeper_lobe_count(const Material& material, Model model);

} // namespace reradiant
