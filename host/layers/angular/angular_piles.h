#pragma once

#include "host/layers/angular/angular_grid.h"
#include "host/layers/smooth/smooth_stack.h"
#include "host/layers/stack/cosine_nodes.h"

#include <Eigen/Core>

namespace reradiant {

/// These are piles of smooth interfaces and clear slabs between the angular cells of what scatters
/// above and below them. They are integrated over the invariant n^2 sin^2 with exact edges and
/// weights that sum to 1: a lossless pile loses nothing to the quadrature.

/// A `CellPile` is a pile between two grids.
struct CellPile {
    Eigen::MatrixXd down; ///< share of an upper cell's flux, (lower cells, upper cells)
    Eigen::MatrixXd up;   ///< (upper cells, lower cells)
    Eigen::VectorXd back_up, back_down;
};
CellPile pile_between(const SmoothStack& media, const AngularGrid& upper, const AngularGrid& lower);

/// An `AirPile` is the pile between the air and the topmost grid.
struct AirPile {
    Eigen::VectorXd through; ///< share of a cell's flux that gets out
    Eigen::VectorXd back;    ///< share that comes back
};
AirPile air_pile(const SmoothStack& media, const AngularGrid& grid);

/// A `SubstratePile` is the pile between the lowest grid and the substrate, for `weights` functions
/// of the cosine in the lowest medium by which the substrate weighs light that arrives and by which
/// it sends it out diffusely.
struct SubstratePile {
    Eigen::MatrixXd through;      ///< (cells, weights): share of a cell's flux there, weighted
    Eigen::VectorXd back;         ///< share that comes back
    Eigen::MatrixXd emitted;      ///< (cells, weights): share of the emission that gets to a cell
    Eigen::MatrixXd emitted_back; ///< (weights sent, weights received): what comes back at once
};
/// The weights are those of `CosineNodes`.
SubstratePile substrate_pile(const SmoothStack& media, const AngularGrid& grid,
                             const CosineNodes& nodes);

} // namespace reradiant
