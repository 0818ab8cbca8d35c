#include "host/layers/rough/lost_flux.h"

#include "host/layers/rough/interface_operator.h"
#include "host/layers/rough/interface_walk.h"
#include "kernels/walk/walk_facets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace reradiant {

using kernels::Vec3;

namespace {

constexpr LatticeRule cell_rule{4093, 220}; ///< as in lattice_rule

/// Share of the light from wi that an all-reflecting surface of V-cavities sends out at once.
double reflected_once(double alpha, const Vec3& wi, double u1, double u2) {
    const Vec3 h = kernels::microfacet_sample(MICROFACET_BLINN, alpha, wi, u1, u2);
    const double cos_h = kernels::vec3_dot(wi, h);
    const Vec3 wo = kernels::walk_reflected(wi, h);
    if (cos_h <= 0.0 || wo.z <= 0.0)
        return 0.0;
    const kernels::WalkSurface mirror{MICROFACET_BLINN, alpha, 1.0, 1, 1, nullptr};
    return kernels::walk_drawn_share(mirror, wi, h, wo, cos_h);
}

/// Mean share over a cell that single scattering keeps.
double kept_in_cell(double eta, double alpha, bool from_below, double low, double high,
                    unsigned seed) {
    const WalkStream stream(cell_rule, seed);
    std::vector<Departure> departures;
    double kept = 0.0;
    for (unsigned walk = 0; walk < cell_rule.count; ++walk) {
        WalkNumbers numbers(stream, walk);
        const double c =
            std::min(std::sqrt(low * low + (high - low) * (high + low) * numbers.next()), 1.0);
        if (eta == 0.0) {
            const double u1 = numbers.next(), u2 = numbers.next();
            kept += reflected_once(alpha, kernels::vec3(std::sqrt(1.0 - c * c), 0.0, c), u1, u2);
            continue;
        }
        departures.clear();
        scatter_at_interface({eta, Distribution::Blinn, alpha, Scattering::Single}, from_below, c,
                             numbers, departures);
        for (const Departure& departure : departures)
            kept += departure.share;
    }
    return kept / cell_rule.count;
}

} // namespace

LostFlux::LostFlux(double eta, double alpha) {
    const InterfaceOperator op = empty_interface_operator({std::max(eta, 1.0)});
    const bool has_dense_side = eta > 0.0;
    std::vector<double> cells, cumulative;
    double total = 0.0;
    const auto append_side = [&](const AngularGrid& grid, bool below) {
        const Eigen::VectorXd etendue = grid.etendue();
        cells.insert(cells.end(), grid.edges.begin(), grid.edges.end());
        for (int cell = 0; cell < grid.cells(); ++cell) {
            const auto k = static_cast<std::size_t>(cell);
            const double kept = kept_in_cell(eta, alpha, below, grid.edges[k], grid.edges[k + 1],
                                             static_cast<unsigned>(cumulative.size()));
            // nothing is created, but a full share is known to the rule's error only
            cells.push_back(std::max(1.0 - kept, 0.0));
            total += etendue(cell) * cells.back();
            cumulative.push_back(total);
        }
    };
    append_side(op.above, false);
    if (has_dense_side)
        append_side(op.below, true);
    const double dense_cells = has_dense_side ? op.below.cells() : 0;
    table_ = {static_cast<double>(op.above.cells()), dense_cells, total};
    table_.insert(table_.end(), cells.begin(), cells.end());
    table_.insert(table_.end(), cumulative.begin(), cumulative.end());
}

std::shared_ptr<const LostFlux> LostFlux::of(double eta, double alpha) {
    static std::mutex mutex;
    static std::map<std::pair<double, double>, std::shared_ptr<const LostFlux>> known;
    const std::scoped_lock lock(mutex);
    auto& flux = known[{eta, alpha}];
    if (!flux)
        flux.reset(new LostFlux(eta, alpha));
    return flux;
}

} // namespace reradiant
