#pragma once

#include "reradiant/scene.h"
#include "reradiant/wavelength_grid.h"

#include <optional>
#include <vector>

namespace reradiant {

/// Returns the matrices that a material holds: its substrate's, and shares of dyes that
/// absorb in its layers.
std::vector<const ReradiationMatrix*> matrices_of(const Material& material);

/// Returns the grid that holds every band of the matrices, of emission and of excitation; nothing
/// where there is no matrix, and where bands differ in step or lie between each other.
std::optional<WavelengthGrid> common_grid(const std::vector<const ReradiationMatrix*>& matrices);

} // namespace reradiant
