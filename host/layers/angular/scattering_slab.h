#pragma once

#include "host/layers/angular/angular_grid.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// A `SlabOperator` says how a slab reflects and transmits azimuthally averaged flux in its own
/// medium. The cells of direction are the same on both sides: (i, j) is the share of cell j's flux
/// that leaves through cell i on the same side (`back`) or on the other side (`through`, which
/// includes what was not scattered). The slab is the same from above and from below.
struct SlabOperator {
    Eigen::MatrixXd back, through;
};

/// Returns the operator of a slab of optical depths `tau` (absorption) and `tau_scattering` > 0
/// whose phase function is that of Henyey and Greenstein 1941 with mean cosine `anisotropy`,
/// -1 < g < 1.
///
/// The phase function between two cells is integrated exactly, by its Legendre series g^l (2l + 1)
/// P_l P_l / 2 over cells. A thin layer follows by the implicit midpoint rule (the diamond
/// initialisation of Wiscombe 1976), which conserves the flux at any thickness, and the slab by
/// doubling (van de Hulst 1963). Reciprocal; without absorption nothing is lost.
SlabOperator scattering_slab(const AngularGrid& grid, double tau, double tau_scattering,
                             double anisotropy);

/// A scattering slab that sends light out, the same everywhere in it and in all directions. Its
/// power is 1.
struct EmittingSlab {
    SlabOperator op;
    Eigen::VectorXd fluence; ///< mean in the slab per flux that enters through a cell, either side
    double own_fluence;      ///< mean in the slab per power that it sends out
};

/// Returns slabs of the thickness given, of twice that, and so on, `count` of them.
std::vector<EmittingSlab> emitting_slabs(const AngularGrid& grid, double tau, double tau_scattering,
                                         double anisotropy, int count);

} // namespace reradiant
