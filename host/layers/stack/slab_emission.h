#pragma once

#include "reradiant/layer_stack.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// Returns what part of the power that a dye absorbs in a band it sends out in each: (bands.count,
/// bands.count), rows = emission, unit 1, within the same band on the diagonal. Shares on another
/// grid are brought onto this one as a matrix is (fluorescence_on_cells). Column sums are at most
/// the yield for Stokes shifts. std::invalid_argument for a yield or an emission out of range.
Eigen::MatrixXd dye_shares(const SlabDye& dye, const WavelengthGrid& bands);

/// Returns what a slab's dyes send out: (bands.count, bands.count), rows = emission. Entry (o, i)
/// times the fluence in band i is the power sent out in band o by a layer as thick as the slab:
/// the dyes' shares times their optical depths. Empty for a slab without dyes.
Eigen::MatrixXd slab_emission(const Layer& layer, const WavelengthGrid& bands);

/// Returns slab_emission of every slab, from the air down.
std::vector<Eigen::MatrixXd> slab_emissions(const LayerStack& stack, const WavelengthGrid& bands);

} // namespace reradiant
