#pragma once

#include "host/layers/angular/angular_grid.h"
#include "host/layers/rough/interface_operator.h"
#include "reradiant/stack_elements.h"

#include <Eigen/Core>

#include <memory>

namespace reradiant {

/// A rough interface or a slab that scatters, between its neighbours; `response`(i, j): share of
/// cell j's flux that leaves through cell i; upper cells first, then lower ones.
struct Scatterer {
    AngularGrid upper, lower;
    Eigen::MatrixXd response;
    bool loses = false; ///< flux that `response` lacks is lost, not absorbed
    double depth = 0.0; ///< optical depth of a slab, scattering included
};

/// Returns the cells of direction in a slab: they know where light can leave into the air.
AngularGrid slab_grid(const SlabValues& slab);

Scatterer scatterer_of(const SlabValues& slab);
Scatterer scatterer_of(const SurfaceValues& interface);

/// The operator of a rough interface, thinner side first whatever lies above.
std::shared_ptr<const InterfaceOperator> operator_of(const SurfaceValues& interface);

} // namespace reradiant
