#pragma once

#include "reradiant/scene.h"
#include "reradiant/stack_elements.h"
#include "reradiant/wavelength_grid.h"

#include <cstddef>
#include <vector>

namespace reradiant {

/// A `VariantGrid` says for which stacks a page carries tables, so that its sliders need no other.
/// Bands whose stacks differ only in the depth of one slab are one class: `bases` holds the stack
/// at depth 1 (the optical depth of that slab, or a factor on all depths), and a band stands at
/// `depths` of its class. Sliders move along the depth and along the width of the first surface.
struct VariantGrid {
    std::vector<double> alphas;        ///< ascending, of the first surface; one where it is fixed
    std::size_t own_alpha = 0;         ///< index of the material's own
    std::vector<std::size_t> class_of; ///< by band
    std::vector<double> depths;        ///< by band, of the material as it is
    std::vector<StackElements> bases;  ///< by class
    std::vector<double> nodes;         ///< depths that are tabulated, ascending
    bool absorbs = false;              ///< some slab absorbs

    std::size_t variants() const { return alphas.size() * bases.size() * nodes.size(); }
    /// The stack of a variant; alphas run slowest and depths fastest.
    StackElements stack(std::size_t variant) const;
};

/// What the tables of a page are of.
struct VariantRequest {
    bool with_sliders = true;   ///< else the material as it is, alone
    bool with_conductor = true; ///< stacks end in their conductor; else above it
};

/// Chooses the variants of a material on the bands. Input Error for numbers out of range.
VariantGrid variant_grid(const Material& material, const WavelengthGrid& bands,
                         const VariantRequest& request);

} // namespace reradiant
