#include "host/layers/angular/invariant_quadrature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// Rule in u with x = node(s, c), s = sin(pi u / 2), c its cosine; `weight` is its derivative.
template <typename Node, typename Weight>
Quadrature mapped_rule(int count, const Node& node, const Weight& weight) {
    const Quadrature& rule = gauss_legendre(count);
    Quadrature mapped;
    double total = 0.0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double u = 0.5 * std::numbers::pi * rule.nodes[i];
        mapped.nodes.push_back(node(std::sin(u), std::cos(u)));
        mapped.weights.push_back(rule.weights[i] * weight(std::sin(u), std::cos(u)));
        total += mapped.weights.back();
    }
    for (double& one : mapped.weights)
        one /= total;
    return mapped;
}

Quadrature end_gathered(int count) {
    return mapped_rule(
        count, [](double s, double) { return s * s; },
        [](double s, double c) { return 2.0 * s * c; });
}

} // namespace

const Quadrature& end_gathered_rule() {
    static const Quadrature rule = end_gathered(6);
    return rule;
}

const Quadrature& finer_end_gathered_rule() {
    static const Quadrature rule = end_gathered(8);
    return rule;
}

const Quadrature& grazing_rule() {
    static const Quadrature rule = mapped_rule(
        24, [](double, double c) { return 1.0 - c * c * c * c; },
        [](double s, double c) { return c * c * c * s; });
    return rule;
}

std::vector<double> edges_towards(std::vector<double> edges, const std::vector<double>& grazing) {
    edges.insert(edges.end(), grazing.begin(), grazing.end());
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<double> added;
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        const auto above = std::lower_bound(grazing.begin(), grazing.end(), edges[k + 1]);
        if (above == grazing.end() || *above == edges[k + 1])
            continue;
        for (double gap = 4.0 * (*above - edges[k + 1]); gap < *above - edges[k]; gap *= 4.0)
            added.push_back(*above - gap);
    }
    edges.insert(edges.end(), added.begin(), added.end());
    std::sort(edges.begin(), edges.end());
    return edges;
}

int cell_at(const AngularGrid& grid, double q) {
    const double c2 = 1.0 - q / (grid.ior * grid.ior);
    return c2 > 0.0 ? grid.cell_of(std::sqrt(c2)) : -1;
}

} // namespace reradiant
