#pragma once

#include "reradiant/layer_stack.h"

#include <memory>
#include <vector>

namespace reradiant {

/// `LostFlux` holds the flux that a rough surface of V-cavities (blinn) loses to single scattering
/// and gives back, when its scattering is `multiple`, in the reciprocal product form d d / sum d
/// (Kelemen and Szirmay-Kalos 2001): light from cosine c is given back with the share lost(c), into
/// both media in proportion to n^2 c lost(c). For a dielectric interface this is the flux that its
/// operator (host/layers/rough/interface_operator.h) adds, to some per cent of it, in finer cells
/// of direction and without noise where nothing is lost.
class LostFlux {
public:
    /// The table that kernels/walk/walk_cavities.h describes and reads.
    const std::vector<double>& table() const { return table_; }
    /// Returns the share of the light from `cosine` above that is given back above, unit 1; linear
    /// between the middles of cells.
    double given_back(double cosine) const;

    /// Returns the lost flux of a surface, shared by all who ask for the same one; thread-safe.
    /// `eta` >= 1 is the IOR ratio of a dielectric interface; 0 stands for an opaque surface that
    /// reflects everything and has side 0 alone.
    static std::shared_ptr<const LostFlux> of(double eta, double alpha);

private:
    LostFlux(double eta, double alpha);

    std::vector<double> table_;
};

} // namespace reradiant
