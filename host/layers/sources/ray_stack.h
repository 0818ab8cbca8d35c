#pragma once

#include "host/layers/sources/depth_cells.h"
#include "reradiant/stack_elements.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace reradiant {

/// What becomes of light of one invariant q = n^2 sin^2 in a pile of smooth interfaces and slabs
/// that do not scatter, all interreflections included. Shares are of a flux that comes from above
/// or from below; every one is a sum of positive terms, so that none loses digits.
struct RayResponse {
    double transmission = 1.0;                 ///< the same in both directions
    double back_above = 0.0, back_below = 0.0; ///< share that comes back
    double absorbed_below = 0.0;               ///< of what comes from below, by anything
    /// By source: mean fluence in a depth cell per flux, or irradiance on the substrate. By
    /// reciprocity a source of power J sends the flux J x dq / g out on that side, g its
    /// weight.
    Eigen::VectorXd from_above, from_below;
};

/// Sums over the invariant of what sources do to each other.
struct RayExchange {
    /// (sources, sources), symmetric: times 1 / g of the column's source this is the fluence (or
    /// irradiance) at the row's source per power of the column's.
    Eigen::MatrixXd between;
    /// Times 1 / g: share of a source's power that is guided for ever in lossless slabs.
    Eigen::VectorXd guided;
};

/// A pile of smooth interfaces and slabs that count as clear (what they scatter is lost), with the
/// sources in it: depth cells of slabs from the air down, then a black substrate where it is one
/// that sends light out.
class RayStack {
public:
    /// `run` lies beneath a medium of IOR `ior_above`; `cells` has one entry for each of its slabs.
    /// A diffuse substrate at its end is a source.
    RayStack(double ior_above, std::span<const StackElement> run,
             std::span<const DepthCells> cells);

    Eigen::Index sources() const { return static_cast<Eigen::Index>(weights_.size()); }
    /// g: 4 n^2 of a depth cell, n^2 of the medium above the substrate.
    const Eigen::VectorXd& weights() const { return weights_; }
    /// IOR of all media, from above.
    const std::vector<double>& media() const { return media_; }

    /// Returns the response of light whose n_ref^2 cos^2 is `reference_g2` in a medium of IOR
    /// n_ref. Adds `weight` times what sources do to each other to an exchange that is given.
    RayResponse at(double reference_ior, double reference_g2, double weight = 0.0,
                   RayExchange* exchange = nullptr) const;

private:
    struct Part {
        enum class Kind { Interface, Clear, Cell, Substrate } kind;
        std::size_t medium; ///< of an interface the one above
        double depth = 0.0; ///< optical depth of a slab or cell
        FilmValues film{};
        double wavelength_nm = 0.0;
    };
    class Fold;

    void add_slab(const SlabValues& slab, const DepthCells& cells);

    std::vector<double> media_;
    std::vector<Part> parts_;
    Eigen::VectorXd weights_;
};

} // namespace reradiant
