#include "host/layers/angular/angular_piles.h"

#include "host/layers/stack/quadrature.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

/// Nodes on [0, 1] gathered at both ends, where transmission may start as a square root; weights
/// that sum to 1 exactly, so that lossless media lose nothing to the rule.
Quadrature end_gathered_rule() {
    const Quadrature& rule = gauss_legendre(6);
    Quadrature gathered;
    double total = 0.0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double u = 0.5 * std::numbers::pi * rule.nodes[i];
        gathered.nodes.push_back(std::sin(u) * std::sin(u));
        gathered.weights.push_back(rule.weights[i] * std::sin(2.0 * u));
        total += gathered.weights.back();
    }
    for (double& weight : gathered.weights)
        weight /= total;
    return gathered;
}

/// Calls visit(q, weight) for a quadrature over the invariant q = n^2 sin^2 between the edges.
template <typename Visit>
void integrate_invariant(std::vector<double> edges, const Visit& visit) {
    static const Quadrature rule = end_gathered_rule();
    std::sort(edges.begin(), edges.end());
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        const double width = edges[k + 1] - edges[k];
        for (std::size_t i = 0; width > 1e-15 && i < rule.nodes.size(); ++i)
            visit(edges[k] + width * rule.nodes[i], rule.weights[i] * width);
    }
}

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

/// Cell that holds the invariant, or -1 beyond the medium's range.
int cell_at(const AngularGrid& grid, double q) {
    const double c2 = 1.0 - q / (grid.ior * grid.ior);
    return c2 > 0.0 ? grid.cell_of(std::sqrt(c2)) : -1;
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
