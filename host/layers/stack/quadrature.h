#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace reradiant {

/// Nodes and weights on [0, 1].
struct Quadrature {
    std::vector<double> nodes, weights;
};

/// Returns the Gauss-Legendre rule with `count` nodes, found by Newton steps on the Legendre
/// polynomial and kept for later calls. Thread-safe.
const Quadrature& gauss_legendre(int count);

/// Calls visit(c, weight) for the nodes of the rule that `integrate_sin2` takes; the weights count
/// in pi / 2 (to - from).
template <typename Visit>
void for_sin2_nodes(double from, double to, int count, const Visit& visit);

/// Returns the integral of f over [from, to] by c = from + (to - from) sin^2 u with Gauss-Legendre
/// in u: exact to 4e-12 with 64 nodes for integrands with square-root ends (critical cosines).
template <typename Function>
double integrate_sin2(double from, double to, int count, const Function& f);

/// Integrates f over consecutive pieces, each as `integrate_sin2` does with `count` nodes; `breaks`
/// ascends and holds both ends.
template <typename Function>
double integrate_pieces(const std::vector<double>& breaks, int count, const Function& f);

/// Returns the points within (0, 1), sorted, with 0 and 1 added; points closer than 1e-14 are
/// merged.
std::vector<double> breaks_between_0_and_1(std::vector<double> inner);

template <typename Visit>
void for_sin2_nodes(double from, double to, int count, const Visit& visit) {
    const Quadrature& rule = gauss_legendre(count);
    const double half_pi = 0.5 * std::numbers::pi;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double s = std::sin(half_pi * rule.nodes[i]);
        const double c = std::cos(half_pi * rule.nodes[i]);
        visit(from + (to - from) * s * s, rule.weights[i] * 2.0 * s * c);
    }
}

template <typename Function>
double integrate_sin2(double from, double to, int count, const Function& f) {
    double sum = 0.0;
    for_sin2_nodes(from, to, count, [&](double c, double weight) { sum += weight * f(c); });
    return sum * 0.5 * std::numbers::pi * (to - from);
}

template <typename Function>
double integrate_pieces(const std::vector<double>& breaks, int count, const Function& f) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        sum += integrate_sin2(breaks[i], breaks[i + 1], count, f);
    return sum;
}

} // namespace reradiant
