#include "host/layers/angular/angular_piles.h"

#include "host/layers/angular/invariant_quadrature.h"

namespace reradiant {

namespace {

/// Edges of the cells and critical invariants of the media, up to `limit`.
std::vector<double> all_edges(const SmoothStack& media, std::vector<double> edges,
                              const std::vector<double>& more, double limit) {
    edges.insert(edges.end(), more.begin(), more.end());
    for (const double n : media.ior)
        edges.push_back(n * n);
    edges.push_back(0.0);
    edges.push_back(limit);
    std::erase_if(edges, [&](double q) { return q > limit || q < 0.0; });
    return edges;
}

SmoothResponse response_at(const SmoothStack& media, double q) {
    const double n = media.ior.front();
    return smooth_response_g2(media, n, n * n - q);
}

} // namespace

CellPile pile_between(const SmoothStack& media, const AngularGrid& upper,
                      const AngularGrid& lower) {
    CellPile pile{Eigen::MatrixXd::Zero(lower.cells(), upper.cells()),
                  Eigen::MatrixXd::Zero(upper.cells(), lower.cells()),
                  Eigen::VectorXd::Zero(lower.cells()), Eigen::VectorXd::Zero(upper.cells())};
    const Eigen::VectorXd upper_e = upper.etendue(), lower_e = lower.etendue();
    const double limit = std::max(upper.ior * upper.ior, lower.ior * lower.ior);
    integrate_invariant(all_edges(media, upper.invariants(), lower.invariants(), limit),
                        [&](double q, double w) {
                            const int u = cell_at(upper, q), l = cell_at(lower, q);
                            const SmoothResponse response = response_at(media, q);
                            if (u >= 0)
                                pile.back_down(u) += w * response.reflection_down / upper_e(u);
                            if (l >= 0)
                                pile.back_up(l) += w * response.reflection_up() / lower_e(l);
                            if (u >= 0 && l >= 0) {
                                pile.down(l, u) += w * response.transmission / upper_e(u);
                                pile.up(u, l) += w * response.transmission / lower_e(l);
                            }
                        });
    return pile;
}

AirPile air_pile(const SmoothStack& media, const AngularGrid& grid) {
    AirPile pile{Eigen::VectorXd::Zero(grid.cells()), Eigen::VectorXd::Zero(grid.cells())};
    const Eigen::VectorXd e = grid.etendue();
    integrate_invariant(all_edges(media, grid.invariants(), {}, grid.ior * grid.ior),
                        [&](double q, double w) {
                            const int cell = cell_at(grid, q);
                            if (cell < 0)
                                return;
                            const SmoothResponse response = response_at(media, q);
                            pile.through(cell) += w * response.transmission / e(cell);
                            pile.back(cell) += w * response.reflection_up() / e(cell);
                        });
    if (media.ior.size() == 1) { // nothing above but air: exactly
        pile.through.setOnes();
        pile.back.setZero();
    }
    return pile;
}

SubstratePile substrate_pile(const SmoothStack& media, const AngularGrid& grid,
                             const CosineNodes& nodes) {
    const Eigen::Index cells = grid.cells(), weights = nodes.size();
    SubstratePile pile{Eigen::MatrixXd::Zero(cells, weights), Eigen::VectorXd::Zero(cells),
                       Eigen::MatrixXd::Zero(cells, weights),
                       Eigen::MatrixXd::Zero(weights, weights)};
    const Eigen::VectorXd e = grid.etendue();
    const double own = media.ior.back() * media.ior.back();
    const double limit = std::max(own, grid.ior * grid.ior);
    integrate_invariant(all_edges(media, grid.invariants(), {}, limit), [&](double q, double w) {
        const int cell = cell_at(grid, q);
        const SmoothResponse response = response_at(media, q);
        if (cell >= 0)
            pile.back(cell) += w * response.reflection_down / e(cell);
        if (!(q < own))
            return;
        const CosineShare share = nodes.at(std::sqrt(1.0 - q / own));
        share.for_nodes([&](Eigen::Index node, double own_share) {
            if (cell >= 0) {
                pile.through(cell, node) += w * own_share * response.transmission / e(cell);
                pile.emitted(cell, node) += w * own_share * response.transmission / own;
            }
            share.for_nodes([&](Eigen::Index other, double other_share) {
                pile.emitted_back(node, other) +=
                    w * own_share * other_share * response.reflection_up() / own;
            });
        });
    });
    return pile;
}

} // namespace reradiant
