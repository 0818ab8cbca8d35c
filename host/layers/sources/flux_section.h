#pragma once

#include <Eigen/Core>

namespace reradiant {

/// A part of a stack between two grids of directions, all interreflections within it included:
/// what it does to azimuthally averaged flux, by shares of a cell's flux, and its sources (depth
/// cells from the air down, then the substrate). A grid may have no cells: nothing comes from
/// there.
struct FluxSection {
    Eigen::VectorXd etendue_above, etendue_below; ///< of the cells: integral of d(n^2 sin^2)
    Eigen::MatrixXd back_above, back_below;       ///< what comes back on the same side
    Eigen::MatrixXd down, up;
    /// (sources, cells): mean fluence in a depth cell, or irradiance on the substrate, per flux
    /// through a cell of directions. A source of power J sends J times this times the cell's
    /// etendue over g out through it, g its weight (SourceTransport).
    Eigen::MatrixXd from_above, from_below;
    Eigen::MatrixXd between; ///< as in RayExchange
    Eigen::VectorXd guided;

    Eigen::Index sources() const { return between.rows(); }
};

/// Returns a section above another one, whose upper grid is the lower grid of the first.
FluxSection section_above(const FluxSection& above, const FluxSection& below);

/// Returns the section as it is from below.
FluxSection upside_down(const FluxSection& section);

/// Returns (sources of both, cells): what a flux that goes down between two sections does at the
/// sources of both, and one that goes up.
Eigen::MatrixXd from_between_down(const FluxSection& above, const FluxSection& below);
Eigen::MatrixXd from_between_up(const FluxSection& above, const FluxSection& below);

} // namespace reradiant
