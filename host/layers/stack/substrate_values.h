#pragma once

#include "reradiant/stack_elements.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// The bottom of a stack, at the band centres.
struct SubstrateValues {
    /// Diffuse: per-band re-radiation matrix, (bands, bands), rows = emission, entries >= 0.
    Eigen::MatrixXd matrix;
    double sigma = 0.0; ///< Oren-Nayar, radians; 0: Lambertian
    /// A conductor at every band instead; empty: diffuse.
    std::vector<SurfaceValues> conductor = {};

    /// Returns what a stack ends in at a band.
    StackElement at_band(std::size_t band) const {
        return conductor.empty() ? StackElement(DiffuseValues{.sigma = sigma})
                                 : StackElement(conductor[band]);
    }
};

} // namespace reradiant
