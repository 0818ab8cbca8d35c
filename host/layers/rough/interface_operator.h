#pragma once

#include "host/layers/angular/angular_grid.h"
#include "host/layers/rough/interface_walk.h"

#include <Eigen/Core>

#include <memory>

namespace reradiant {

/// Azimuthally averaged scattering of one rough interface between media of IOR 1 (above) and
/// eta >= 1 (below), on cells of both sides: above cells first, then below cells.
///
/// `exchange`(i, j) is the flux that leaves through cell i per unit radiance / pi entering through
/// cell j: symmetric (reciprocity with its n^2 factors), and its columns sum to the cells' etendue
/// when nothing is lost. The share of cell j's flux that leaves through cell i is
/// exchange(i, j) / etendue(j).
struct InterfaceOperator {
    RoughInterface interface;
    AngularGrid above, below;
    Eigen::MatrixXd exchange;
    /// Albedo of the single-scattering reflection lobe F D G2 / (4 ci co), mean over each above
    /// cell.
    Eigen::VectorXd first_lobe;

    Eigen::VectorXd etendue() const;
};

/// Number of cells on each side.
inline constexpr int interface_cells = 64;

/// Computes the operator from lattice-sampled walks in every cell (parallel, the same whatever the
/// thread count). Each pair of cells is estimated from both ends, weighted by the inverse of
/// their variances, then each cell's split between reflection and transmission is set back to its
/// own estimate (Sinkhorn scaling of each block, which keeps the symmetry). `multiple` is then made
/// exactly energy-conserving and stays symmetric: by a symmetric Sinkhorn scaling D S D for ggx and
/// beckmann; for blinn, whose V-cavities have no walk here, by adding the lost flux back in the
/// reciprocal product form d d^T / sum d (Kelemen and Szirmay-Kalos 2001), d = what each cell
/// loses.
InterfaceOperator compute_interface_operator(const RoughInterface& interface);

/// Returns the operator without its numbers: the grids for an interface of this IOR ratio.
InterfaceOperator empty_interface_operator(const RoughInterface& interface);

/// Scales a symmetric non-negative matrix S to D S D with column sums `target`.
void scale_symmetric(Eigen::MatrixXd& matrix, const Eigen::VectorXd& target);

/// Returns the operator of an interface from memory, from the disk cache
/// (cache_directory()/interfaces), or computed. Ratios of IOR are rounded to 1e-4; those on a
/// multiple of 0.01 are computed as they are, others interpolated cubically between multiples of
/// 0.05 (0.01 below 1.1), so that a dispersive material costs a few operators and not one for each
/// wavelength. Thread-safe.
std::shared_ptr<const InterfaceOperator> interface_operator(const RoughInterface& interface);

} // namespace reradiant
