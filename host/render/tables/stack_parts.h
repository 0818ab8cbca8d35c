#pragma once

#include "reradiant/scene.h"

#include <cstddef>
#include <vector>

namespace reradiant {

/// A `StackPart` is something that reflects in a stack under model A: an interface, a sheet of
/// flakes at the lower end of its slab, or the conductor that the stack may stand on. Parts are
/// listed from the air down, and LayerRecords are in this order.
struct StackPart {
    enum class Kind { Interface, Flakes, Conductor };
    Kind kind = Kind::Interface;
    std::size_t layer = 0; ///< index of the interface or slab; a conductor's: number of layers
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0;

    /// Slabs that light crosses on its way to this part.
    std::size_t slabs_above() const { return kind == Kind::Flakes ? layer + 1 : layer; }
};
std::vector<StackPart> stack_parts(const Material& material);

/// A lobe beneath the top one under model A: of a rough part, or what a slab scatters.
struct DeeperLobe {
    bool is_slab = false;
    std::size_t part = 0;  ///< index into the parts; a slab's: number of parts above it
    std::size_t layer = 0; ///< slabs that light crosses on its way to it
};
std::vector<DeeperLobe> weidlich_wilkie_lobes(const Material& material);

/// Under model A: every part is smooth and no slab scatters, so that tables by the angle hold the
/// whole model.
bool is_all_smooth(const Material& material);

/// A material at one wavelength. `conductor` holds nothing where there is none.
struct MaterialValues {
    StackValues stack;
    ConductorValues conductor;

    /// IOR of the medium under the first `count` interfaces.
    double ior_below(std::size_t count) const { return count > 0 ? stack[count - 1].ior : 1.0; }
    /// Reflectance at a facet of a part; of a sheet: of its flakes.
    double facet_reflectance(const StackPart& part, double cos_theta) const;
};
MaterialValues material_at(const Material& material, double wavelength_nm);

} // namespace reradiant
