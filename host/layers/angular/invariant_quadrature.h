#pragma once

#include "host/layers/angular/angular_grid.h"
#include "host/layers/stack/quadrature.h"

#include <algorithm>
#include <vector>

namespace reradiant {

/// Nodes on [0, 1] gathered at both ends, where transmission may start as a square root; weights
/// that sum to 1 exactly, so that lossless media lose nothing to the rule.
const Quadrature& end_gathered_rule();
/// The same with more nodes, for functions that rise towards an end without reaching it.
const Quadrature& finer_end_gathered_rule();
/// Nodes that are dense at 1, where light grazes in a medium: there thin layers absorb within a
/// small range of cosines.
const Quadrature& grazing_rule();

/// Calls visit(q, weight) for a rule over the invariant q = n^2 sin^2 from one value to another.
template <typename Visit>
void integrate_piece(double from, double to, const Quadrature& rule, const Visit& visit) {
    const double width = to - from;
    for (std::size_t i = 0; width > 1e-15 && i < rule.nodes.size(); ++i)
        visit(from + width * rule.nodes[i], rule.weights[i] * width);
}

/// Calls visit(q, weight) for a quadrature between the edges.
template <typename Visit>
void integrate_invariant(std::vector<double> edges, const Visit& visit) {
    std::sort(edges.begin(), edges.end());
    for (std::size_t k = 0; k + 1 < edges.size(); ++k)
        integrate_piece(edges[k], edges[k + 1], end_gathered_rule(), visit);
}

/// Adds edges so that no piece is more than three times as long as its distance to a value of
/// `grazing` above it, but for pieces that end in one. Sorts them.
std::vector<double> edges_towards(std::vector<double> edges, const std::vector<double>& grazing);

/// Does the same for functions that rise as 1 / cos towards the values of `grazing`, n^2 of the
/// media in which light is sent out.
template <typename Visit>
void integrate_grazing(std::vector<double> edges, const std::vector<double>& grazing,
                       const Visit& visit) {
    edges = edges_towards(std::move(edges), grazing);
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        const bool grazes =
            std::find(grazing.begin(), grazing.end(), edges[k + 1]) != grazing.end();
        integrate_piece(edges[k], edges[k + 1], grazes ? grazing_rule() : finer_end_gathered_rule(),
                        visit);
    }
}

/// Returns the cell that holds the invariant, or -1 beyond the medium's range.
int cell_at(const AngularGrid& grid, double q);

} // namespace reradiant
