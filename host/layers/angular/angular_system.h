#pragma once

#include "host/layers/angular/angular_piles.h"
#include "host/layers/angular/scatterer.h"
#include "reradiant/stack_elements.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// `AngularShares` says where light ends up, by the cell of direction that it comes through. The
/// substrate is black.
struct AngularShares {
    Eigen::VectorXd to_substrate; ///< share that reaches the substrate
    Eigen::VectorXd to_air;       ///< share that leaves again into the air
    Eigen::VectorXd lost;         ///< share lost to single scattering
};

/// An `AngularResponse` says where light ends up that comes down to the first scatterer, by cell of
/// its upper side, and where light ends up that the substrate emits.
struct AngularResponse {
    AngularShares incoming;
    /// If the first scatterer is a slab, the shares of the light that leaves it downwards, by the
    /// same cells; empty for a rough interface.
    AngularShares passed;
    double internal_reflectance = 0.0;
    double escape = 0.0; ///< share of the substrate's flux that leaves into the air
};

/// Adding on azimuthally averaged flux (Fourier order 0): the operators of what scatters, rough
/// interfaces and slabs, with smooth piles of media between them, solved for all interreflections
/// at once by one LU of the value function (the adjoint), on the cells of both sides of them all.
class AngularSystem {
public:
    /// Sets up the elements above a substrate, some of which must scatter.
    explicit AngularSystem(std::span<const StackElement> stack);

    /// Solves for all interreflections. The substrate emits diffusely.
    AngularResponse solve() const;
    /// Returns what comes back of what the substrate emits, (nodes, nodes): the share of diffuse
    /// emission weighted by one node's function of the cosine, weighted by another's on its return.
    Eigen::MatrixXd returned(const CosineNodes& nodes) const;
    /// Media and slabs from the air to the medium above the first scatterer.
    const SmoothStack& top() const { return top_media_; }
    const AngularGrid& top_grid() const { return scatterers_.front().upper; }
    /// Optical depth, scattering included, of a slab that is the first scatterer; else 0.
    double top_depth() const { return scatterers_.front().depth; }
    /// Reflection lobe of a rough interface that is the first scatterer, mean over each cell of its
    /// upper side. Only known for one towards a denser medium, else empty.
    const Eigen::VectorXd& first_lobe() const { return first_lobe_; }
    /// Share of the light that this interface sends back after more than one event at its facets,
    /// by the same cells; empty likewise.
    const Eigen::VectorXd& between_facets() const { return between_facets_; }

private:
    void add_interface(const SurfaceValues& interface);
    /// Values of outgoing flux as a linear function of the values of incoming flux.
    Eigen::MatrixXd coupling(const SubstratePile& substrate) const;
    /// Values of incoming flux, one column for each of `outgoing` and, in front of them, the share
    /// that is lost at scatterers.
    Eigen::MatrixXd values_of(const Eigen::MatrixXd& outgoing, const Eigen::MatrixXd& links) const;
    Eigen::Index size() const;

    std::vector<Scatterer> scatterers_;
    std::vector<CellPile> between_;
    SmoothStack top_media_, bottom_media_;
    AirPile air_;
    Eigen::VectorXd first_lobe_, between_facets_;
};

} // namespace reradiant
