#include "host/layers/rough/lost_flux.h"

#include "host/layers/rough/interface_operator.h"
#include "host/layers/rough/interface_walk.h"
#include "kernels/scatter/microfacet.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

constexpr LatticeRule cell_rule{4093, 220}; ///< as in lattice_rule

/// Share of the light from wi that an all-reflecting surface of V-cavities sends out at once.
double reflected_once(double alpha, const Vec3& wi, double u1, double u2) {
    const Vec3 h = kernels::microfacet_sample(MICROFACET_BLINN, alpha, wi, u1, u2);
    const double cos_h = kernels::vec3_dot(wi, h);
    const Vec3 wo = kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * cos_h), wi);
    if (cos_h <= 0.0 || wo.z <= 0.0)
        return 0.0;
    return kernels::microfacet_g2(MICROFACET_BLINN, alpha, wi, wo, h) * cos_h / (wi.z * h.z);
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
    double total = 0.0;
    for (const AngularGrid& grid : {op.above, op.below}) {
        const bool below = !sides_.empty();
        if (below && eta == 0.0)
            break;
        Cells& side = sides_.emplace_back(Cells{grid.ior, grid.edges, {}});
        const Eigen::VectorXd etendue = grid.etendue();
        for (int cell = 0; cell < grid.cells(); ++cell) {
            const auto k = static_cast<std::size_t>(cell);
            const double kept = kept_in_cell(eta, alpha, below, grid.edges[k], grid.edges[k + 1],
                                             static_cast<unsigned>(cumulative_.size()));
            // nothing is created, but a full share is known to the rule's error only
            side.lost.push_back(std::max(1.0 - kept, 0.0));
            total += etendue(cell) * side.lost.back();
            cumulative_.push_back(total);
        }
    }
}

double LostFlux::lost(int side, double cosine) const {
    const Cells& cells = sides_[static_cast<std::size_t>(side)];
    const auto above = std::upper_bound(cells.edges.begin(), cells.edges.end(), cosine);
    const auto last = static_cast<std::ptrdiff_t>(cells.lost.size()) - 1;
    return cells.lost[static_cast<std::size_t>(
        std::clamp(above - cells.edges.begin() - 1, std::ptrdiff_t{0}, last))];
}

double LostFlux::value(int from_side, double from_cosine, int to_side, double to_cosine) const {
    const double total = cumulative_.back();
    const double n = sides_[static_cast<std::size_t>(to_side)].ior;
    return total > 0.0 ? lost(from_side, from_cosine) * lost(to_side, to_cosine) * n * n *
                             std::numbers::inv_pi / total
                       : 0.0;
}

LostFlux::Departure LostFlux::sample(double u1, double u2) const {
    const auto found =
        std::upper_bound(cumulative_.begin(), cumulative_.end(), u1 * cumulative_.back());
    auto cell =
        static_cast<std::size_t>(std::min(found, cumulative_.end() - 1) - cumulative_.begin());
    const std::size_t thin = sides_.front().lost.size();
    const int side = cell < thin ? 0 : 1;
    cell -= side == 0 ? 0 : thin;
    const std::vector<double>& edges = sides_[static_cast<std::size_t>(side)].edges;
    const double low2 = edges[cell] * edges[cell], high2 = edges[cell + 1] * edges[cell + 1];
    return {side, std::min(std::sqrt(low2 + (high2 - low2) * u2), 1.0)};
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
