#pragma once

#include "reradiant/layer_stack.h"

#include <memory>
#include <vector>

namespace reradiant {

/// `LostFlux` holds the flux that a rough surface of V-cavities (blinn) loses to single scattering
/// and gives back, when its scattering is `multiple`, in the reciprocal product form d d / sum d
/// (Kelemen and Szirmay-Kalos 2001): light from cosine c is given back with the share lost(c), into
/// both media in proportion to n^2 c lost(c). For a dielectric interface this is the flux that its
/// operator (host/layers/rough/interface_operator.h) adds, with the same cells of direction.
class LostFlux {
public:
    /// Returns the share of flux from `cosine` on a side that single scattering loses. Side 0 is
    /// the thinner medium, of IOR 1 here; side 1 is the other one, of IOR eta >= 1.
    double lost(int side, double cosine) const;
    /// Returns the BSDF without cosine, 1/sr, of light given back from one direction into another.
    double value(int from_side, double from_cosine, int to_side, double to_cosine) const;
    /// A `Departure` is the side and cosine at which given-back light leaves. `sample` draws one
    /// from two uniform numbers with a probability in proportion to n^2 c lost(c).
    struct Departure {
        int side;
        double cosine;
    };
    Departure sample(double u1, double u2) const;

    /// Cells of direction of one side: cosines ascending, and the lost share of each cell.
    struct Cells {
        double ior = 1.0;
        std::vector<double> edges;
        std::vector<double> lost;
    };
    const std::vector<Cells>& sides() const { return sides_; }
    /// Running sum, over the cells of all sides, of etendue times lost.
    const std::vector<double>& cumulative() const { return cumulative_; }

    /// Returns the lost flux of a surface, shared by all who ask for the same one; thread-safe.
    /// `eta` >= 1 is the IOR ratio of a dielectric interface; 0 stands for an opaque surface that
    /// reflects everything and has side 0 alone.
    static std::shared_ptr<const LostFlux> of(double eta, double alpha);

private:
    LostFlux(double eta, double alpha);

    std::vector<Cells> sides_;
    std::vector<double> cumulative_;
};

} // namespace reradiant
