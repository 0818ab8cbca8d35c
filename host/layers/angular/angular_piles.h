#pragma once

#include "host/layers/angular/angular_grid.h"
#include "host/layers/smooth/smooth_stack.h"

#include <Eigen/Core>

#include <functional>

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

/// A function of the cosine in the lowest medium by which the substrate weighs light that arrives
/// and by which it sends it out.
using SubstrateWeight = std::function<double(double cosine)>;

/// A `SubstratePile` is the pile between the lowest grid and the substrate.
struct SubstratePile {
    Eigen::VectorXd through;   ///< share of a cell's flux that gets there, weighted
    Eigen::VectorXd back;      ///< share that comes back
    Eigen::VectorXd emitted;   ///< share of the substrate's (weighted) emission that gets to a cell
    double emitted_back = 0.0; ///< share of it that comes back at once, weighted twice
};
SubstratePile substrate_pile(const SmoothStack& media, const AngularGrid& grid,
                             const SubstrateWeight& weight);

} // namespace reradiant
