#pragma once

#include "reradiant/layer_stack.h"
#include "reradiant/wavelength_plan.h"

#include <Eigen/Core>

namespace reradiant {

/// Returns slab_emission of a layer on the lanes of a plan at one phase: (lanes, lanes), rows =
/// emission. Without entries for a slab without dyes.
Eigen::MatrixXd dyes_on_lanes(const Layer& layer, const WavelengthPlan& plan, int phase);

} // namespace reradiant
