#include "host/layers/angular/scatterer.h"

#include "host/layers/angular/scattering_slab.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reradiant {

AngularGrid slab_grid(const SlabValues& slab) {
    const double n = slab.ior;
    const double critical = n > 1.0 ? std::sqrt((n - 1.0) * (n + 1.0)) / n : 0.0;
    return make_angular_grid(n, critical, interface_cells);
}

Scatterer scatterer_of(const SlabValues& slab) {
    const AngularGrid grid = slab_grid(slab);
    const SlabOperator op = scattering_slab(grid, slab.tau, slab.tau_scattering, slab.anisotropy);
    Scatterer scatterer{grid, grid, Eigen::MatrixXd(2 * grid.cells(), 2 * grid.cells())};
    scatterer.response << op.back, op.through, op.through, op.back;
    scatterer.depth = slab.depth();
    return scatterer;
}

std::shared_ptr<const InterfaceOperator> operator_of(const SurfaceValues& interface) {
    const double above = interface.ior_above, below = interface.ior_below;
    const double ratio = below >= above ? below / above : above / below;
    return interface_operator(
        {ratio, interface.distribution, interface.alpha, interface.scattering});
}

namespace {

/// Shares of cells' flux. Operators exist for ratios of IOR of four decimals: where they lose
/// nothing, they are changed to lose nothing between the media that there are.
Eigen::MatrixXd shares_between(const InterfaceOperator& op, const Eigen::VectorXd& etendue) {
    const Eigen::VectorXd own = op.etendue();
    if (op.interface.scattering == Scattering::Single || own.isApprox(etendue, 1e-12))
        return op.exchange * own.cwiseInverse().asDiagonal();
    Eigen::MatrixXd exchange = op.exchange;
    scale_symmetric(exchange, etendue);
    return exchange * etendue.cwiseInverse().asDiagonal();
}

} // namespace

Scatterer scatterer_of(const SurfaceValues& interface) {
    const auto op = operator_of(interface);
    const double ratio = std::max(interface.ior_above, interface.ior_below) /
                         std::min(interface.ior_above, interface.ior_below);
    const AngularGrid& thinner = op->above;
    const AngularGrid denser =
        make_angular_grid(ratio, std::sqrt((ratio - 1.0) * (ratio + 1.0)) / ratio, interface_cells);
    Eigen::VectorXd etendue(thinner.cells() + denser.cells());
    etendue << thinner.etendue(), denser.etendue();
    const Eigen::MatrixXd shares = shares_between(*op, etendue);
    const Eigen::Index n = op->above.cells();
    Scatterer rough{thinner, denser, shares, interface.scattering == Scattering::Single};
    if (interface.ior_below < interface.ior_above) {
        // the operator is stored thinner side first; the surface looks alike from below
        std::swap(rough.upper, rough.lower);
        rough.response << shares.bottomRightCorner(n, n), shares.bottomLeftCorner(n, n),
            shares.topRightCorner(n, n), shares.topLeftCorner(n, n);
    }
    rough.upper.ior = interface.ior_above;
    rough.lower.ior = interface.ior_below;
    return rough;
}

} // namespace reradiant
