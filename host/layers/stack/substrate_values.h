#pragma once

#include "reradiant/layer_stack.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// The bottom of a stack, at the band centres.
struct SubstrateValues {
    /// Diffuse: per-band re-radiation matrix, (bands, bands), rows = emission, entries >= 0.
    Eigen::MatrixXd matrix;
    double sigma = 0.0; ///< Oren-Nayar, radians; 0: Lambertian
    /// A conductor at every band instead; empty: diffuse.
    std::vector<ConductorValues> conductor = {};
};

} // namespace reradiant
