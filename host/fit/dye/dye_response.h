#pragma once

#include "host/fit/dye/dye_stack.h"
#include "host/fit/dye/emission_shares.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// The unknown dyes of a sample, and what else about it may be asked to change.
struct DyeValues {
    Eigen::MatrixXd depth;              ///< (bands, dyes): optical depth of the layer
    std::vector<EmissionShares> shares; ///< by dye
    Eigen::VectorXd quantum_yield;      ///< by dye
    Eigen::VectorXd reflectance_added;  ///< to the substrate's diagonal, by band; empty: nothing
};

/// Bands of the grid that light is sent in at and looked for at.
struct BandRange {
    Eigen::Index first = 0, count = 0;
};

/// What one view sees, (emission, excitation), and its derivatives: entries in column-major order
/// in the rows.
struct DyeImage {
    Eigen::MatrixXd value;
    Eigen::MatrixXd by_depth;       ///< (entries, bands * dyes), one dye after the other
    Eigen::MatrixXd by_emission;    ///< likewise
    Eigen::MatrixXd by_yield;       ///< (entries, dyes)
    Eigen::MatrixXd by_reflectance; ///< (entries, bands); empty where none is added
};

/// Returns what every view of a sample sees: light that its dyes and its substrate send out, to all
/// orders of re-absorption, by one pass over the bands. Derivatives, when they are asked for, take
/// one pass backwards (the adjoint: what a view sees of light sent out anywhere in any band), and
/// are exact for what the tables of `stack` hold.
std::vector<DyeImage> dye_images(const DyeStack& stack, const DyeValues& values,
                                 const BandRange& emission, const BandRange& excitation,
                                 bool with_derivatives);

} // namespace reradiant
