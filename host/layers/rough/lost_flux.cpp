#include "host/layers/rough/lost_flux.h"

#include "host/layers/angular/angular_grid.h"
#include "host/layers/rough/interface_walk.h"
#include "kernels/walk/walk_cavities.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace reradiant {

using kernels::Vec3;

namespace {

/// Cells of either side: fine enough that the steps between them do not show. The lost share is
/// computed at the edges of every fourth one and is linear between these.
constexpr int lost_cells = 1024, cells_of_node = 4;
constexpr LatticeRule node_rule{1021, 76}; ///< L'Ecuyer and Lemieux 2000, table 1

/// Share of the light from v that one scattering at a facet does not let out.
double lost_at(const kernels::WalkSurface& surface, const Vec3& v, const Vec3& h, double cos_h) {
    const auto leaves = [&](const Vec3& w) {
        return w.z > 0.0 ? kernels::walk_single_share(surface, v, h, w,
                                                      std::fabs(kernels::vec3_dot(w, h)))
                         : 0.0;
    };
    const double reflectance = kernels::walk_reflectance(surface, cos_h);
    double kept = reflectance * leaves(kernels::walk_reflected(v, h));
    if (reflectance < 1.0) {
        const Vec3 w = kernels::vec3_scale(kernels::walk_refracted(v, h, surface.eta), -1.0);
        kept += (1.0 - reflectance) * leaves(w);
    }
    return 1.0 - kept;
}

/// Share of the light from v that a V-cavity does not let out at once, by the facets that v sees.
double lost_in_cavity(const kernels::WalkSurface& surface, const Vec3& v, const Vec3& h) {
    const Vec3 other = kernels::vec3(-h.x, -h.y, h.z);
    const double seen = std::max(kernels::vec3_dot(v, h), 0.0);
    const double other_seen = std::max(kernels::vec3_dot(v, other), 0.0);
    double lost = 0.0;
    if (seen > 0.0)
        lost += seen * lost_at(surface, v, h, seen);
    if (other_seen > 0.0)
        lost += other_seen * lost_at(surface, v, other, other_seen);
    return lost / (seen + other_seen);
}

/// Share of the light from a cosine that single scattering loses. All cosines use the same points,
/// so that the rule's error changes little from one to the next.
double lost_from(const kernels::WalkSurface& surface, double cosine) {
    const double c = std::max(cosine, 1e-6);
    const Vec3 v = kernels::vec3(std::sqrt((1.0 - c) * (1.0 + c)), 0.0, c);
    const WalkStream stream(node_rule, 0);
    double lost = 0.0;
    for (unsigned point = 0; point < node_rule.count; ++point) {
        WalkNumbers numbers(stream, point);
        const double u1 = numbers.next(), u2 = numbers.next();
        lost += lost_in_cavity(
            surface, v, kernels::microfacet_sample(surface.distribution, surface.alpha, v, u1, u2));
    }
    return lost / node_rule.count;
}

/// Mean lost shares of a grid's cells, over their flux.
std::vector<double> lost_shares(const kernels::WalkSurface& surface, const AngularGrid& grid) {
    std::vector<double> shares;
    double low = 0.0, high = lost_from(surface, grid.edges.front());
    for (int cell = 0; cell < grid.cells(); ++cell) {
        const auto k = static_cast<std::size_t>(cell), node = k / cells_of_node * cells_of_node;
        const double from = grid.edges[node], to = grid.edges[node + cells_of_node];
        if (k == node) {
            low = high;
            high = lost_from(surface, to);
        }
        const double left = grid.edges[k], right = grid.edges[k + 1];
        const double mean = (left * left + left * right + right * right) / (1.5 * (left + right));
        shares.push_back(low + (high - low) * (mean - from) / (to - from));
    }
    return shares;
}

} // namespace

LostFlux::LostFlux(double eta, double alpha) {
    const bool is_mirror = eta == 0.0;
    const kernels::WalkSurface above{MICROFACET_BLINN, alpha,  is_mirror ? 1.0 : eta, 1,
                                     is_mirror,        nullptr};
    std::vector<double> cells, cumulative;
    double total = 0.0;
    const auto append_side = [&](const AngularGrid& grid, const kernels::WalkSurface& surface) {
        const Eigen::VectorXd etendue = grid.etendue();
        cells.insert(cells.end(), grid.edges.begin(), grid.edges.end());
        const std::vector<double> lost = lost_shares(surface, grid);
        cells.insert(cells.end(), lost.begin(), lost.end());
        for (int cell = 0; cell < grid.cells(); ++cell) {
            total += etendue(cell) * lost[static_cast<std::size_t>(cell)];
            cumulative.push_back(total);
        }
    };
    append_side(make_angular_grid(1.0, 0.0, lost_cells), above);
    if (!is_mirror) {
        const double critical = std::sqrt((eta - 1.0) * (eta + 1.0)) / eta;
        append_side(make_angular_grid(eta, critical, lost_cells), kernels::walk_from_beyond(above));
    }
    table_ = {static_cast<double>(lost_cells), is_mirror ? 0.0 : lost_cells, total};
    table_.insert(table_.end(), cells.begin(), cells.end());
    table_.insert(table_.end(), cumulative.begin(), cumulative.end());
}

double LostFlux::given_back(double cosine) const {
    const auto cells = static_cast<std::size_t>(table_[0]);
    const double total = table_[2];
    if (!(total > 0.0))
        return 0.0;
    const double* edges = table_.data() + WALK_CAVITIES_HEADER;
    const double* lost = edges + cells + 1;
    const auto dense_cells = static_cast<std::size_t>(table_[1]);
    const double above = table_[table_.size() - dense_cells - 1]; // the running sum there
    const auto middle = [&](std::size_t k) { return 0.5 * (edges[k] + edges[k + 1]); };
    // the first cell that ends above the cosine, then the two whose middles are around it
    const auto cell =
        static_cast<std::size_t>(std::upper_bound(edges + 1, edges + cells, cosine) - (edges + 1));
    const std::size_t right =
        std::clamp<std::size_t>(cosine < middle(cell) ? cell : cell + 1, 1, cells - 1);
    const double t = (cosine - middle(right - 1)) / (middle(right) - middle(right - 1));
    return std::max(lost[right - 1] + t * (lost[right] - lost[right - 1]), 0.0) * above / total;
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
