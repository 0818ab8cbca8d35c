#include "host/layers/rough_system.h"

#include "host/layers/quadrature.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace reradiant {

bool is_rough_interface(const StackValues& stack, std::size_t index) {
    const double above = index == 0 ? 1.0 : stack[index - 1].ior;
    const double below = stack[index].ior;
    const double ratio = std::max(above, below) / std::min(above, below);
    return stack[index].alpha > 0.0 && ratio - 1.0 > 5e-5;
}

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
    for (double& weight : gathered.weights) {
        weight /= total;
    }
    return gathered;
}

/// Calls visit(q, weight) for a quadrature over the invariant q = n^2 sin^2 between the edges.
template <typename Visit>
void integrate_invariant(std::vector<double> edges, const Visit& visit) {
    static const Quadrature rule = end_gathered_rule();
    std::sort(edges.begin(), edges.end());
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        const double width = edges[k + 1] - edges[k];
        for (std::size_t i = 0; width > 1e-15 && i < rule.nodes.size(); ++i) {
            visit(edges[k] + width * rule.nodes[i], rule.weights[i] * width);
        }
    }
}

/// Edges of the cells and critical invariants of the media, up to `limit`.
std::vector<double> all_edges(const SmoothStack& media, std::vector<double> edges,
                              const std::vector<double>& more, double limit) {
    edges.insert(edges.end(), more.begin(), more.end());
    for (const double n : media.ior) {
        edges.push_back(n * n);
    }
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

SmoothStack media_between(const StackValues& stack, std::size_t first, std::size_t last) {
    SmoothStack media; // medium k lies under interface k - 1; medium 0 is the air
    for (std::size_t k = first; k <= last; ++k) {
        media.ior.push_back(k == 0 ? 1.0 : stack[k - 1].ior);
        media.tau.push_back(k == 0 ? 0.0 : stack[k - 1].tau);
    }
    return media;
}

} // namespace

RoughSystem::RoughSystem(const StackValues& stack, std::size_t count) {
    std::size_t first_medium = 0;
    for (std::size_t k = 0; k < count; ++k) {
        if (is_rough_interface(stack, k)) {
            piles_.push_back(media_between(stack, first_medium, k));
            add_rough(stack, k);
            first_medium = k + 1;
        }
    }
    piles_.push_back(media_between(stack, first_medium, count));
    for (std::size_t p = 0; p + 1 < rough_.size(); ++p) {
        between_.push_back(pile_between(piles_[p + 1], rough_[p].lower, rough_[p + 1].upper));
    }
    air_ = air_pile(piles_.front(), rough_.front().upper);
    substrate_ = substrate_pile(piles_.back(), rough_.back().lower);
}

void RoughSystem::add_rough(const StackValues& stack, std::size_t index) {
    const LayerValues& layer = stack[index];
    const double above = index == 0 ? 1.0 : stack[index - 1].ior;
    const bool denser = layer.ior >= above;
    const double ratio = denser ? layer.ior / above : above / layer.ior;
    const auto op = interface_operator({ratio, layer.distribution, layer.alpha, layer.scattering});
    const Eigen::VectorXd e = op->etendue();
    const Eigen::MatrixXd shares = op->exchange * e.cwiseInverse().asDiagonal();
    const Eigen::Index n = op->above.cells();
    Rough rough{op->above, op->below, shares};
    if (!denser) { // the operator is stored thinner side first; the surface looks alike from below
        std::swap(rough.upper, rough.lower);
        rough.response << shares.bottomRightCorner(n, n), shares.bottomLeftCorner(n, n),
            shares.topRightCorner(n, n), shares.topLeftCorner(n, n);
    }
    rough.upper.ior = above;
    rough.lower.ior = layer.ior;
    if (rough_.empty() && denser) {
        first_lobe_ = op->first_lobe;
    }
    loses_ = loses_ || layer.scattering == Scattering::Single;
    rough_.push_back(std::move(rough));
}

RoughSystem::Pile RoughSystem::pile_between(const SmoothStack& media, const AngularGrid& upper,
                                            const AngularGrid& lower) {
    Pile pile{Eigen::MatrixXd::Zero(lower.cells(), upper.cells()),
              Eigen::MatrixXd::Zero(upper.cells(), lower.cells()),
              Eigen::VectorXd::Zero(lower.cells()), Eigen::VectorXd::Zero(upper.cells())};
    const Eigen::VectorXd upper_e = upper.etendue(), lower_e = lower.etendue();
    const double limit = std::max(upper.ior * upper.ior, lower.ior * lower.ior);
    integrate_invariant(all_edges(media, upper.invariants(), lower.invariants(), limit),
                        [&](double q, double w) {
                            const int u = cell_at(upper, q), l = cell_at(lower, q);
                            const SmoothResponse response = response_at(media, q);
                            if (u >= 0) {
                                pile.back_down(u) += w * response.reflection_down / upper_e(u);
                            }
                            if (l >= 0) {
                                pile.back_up(l) += w * response.reflection_up() / lower_e(l);
                            }
                            if (u >= 0 && l >= 0) {
                                pile.down(l, u) += w * response.transmission / upper_e(u);
                                pile.up(u, l) += w * response.transmission / lower_e(l);
                            }
                        });
    return pile;
}

RoughSystem::EndPile RoughSystem::air_pile(const SmoothStack& media, const AngularGrid& grid) {
    EndPile pile{Eigen::VectorXd::Zero(grid.cells()), Eigen::VectorXd::Zero(grid.cells()), {}, 0.0};
    const Eigen::VectorXd e = grid.etendue();
    integrate_invariant(all_edges(media, grid.invariants(), {}, grid.ior * grid.ior),
                        [&](double q, double w) {
                            const int cell = cell_at(grid, q);
                            if (cell < 0) {
                                return;
                            }
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

RoughSystem::EndPile RoughSystem::substrate_pile(const SmoothStack& media,
                                                 const AngularGrid& grid) {
    EndPile pile{Eigen::VectorXd::Zero(grid.cells()), Eigen::VectorXd::Zero(grid.cells()),
                 Eigen::VectorXd::Zero(grid.cells()), 0.0};
    const Eigen::VectorXd e = grid.etendue();
    const double own = media.ior.back() * media.ior.back();
    const double limit = std::max(own, grid.ior * grid.ior);
    integrate_invariant(all_edges(media, grid.invariants(), {}, limit), [&](double q, double w) {
        const int cell = cell_at(grid, q);
        const SmoothResponse response = response_at(media, q);
        if (cell >= 0) {
            pile.through(cell) += w * response.transmission / e(cell);
            pile.back(cell) += w * response.reflection_down / e(cell);
            pile.emitted(cell) += w * response.transmission / own;
        }
        if (q < own) {
            pile.emitted_back += w * response.reflection_up() / own;
        }
    });
    return pile;
}

Eigen::Index RoughSystem::size() const {
    Eigen::Index n = 0;
    for (const Rough& rough : rough_) {
        n += rough.response.rows();
    }
    return n;
}

Eigen::MatrixXd RoughSystem::coupling() const {
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(size(), size());
    Eigen::Index at = 0;
    for (std::size_t p = 0; p < rough_.size(); ++p) {
        const Eigen::Index upper = rough_[p].upper.cells(), lower = rough_[p].lower.cells();
        k.block(at, at, upper, upper) = (p == 0 ? air_.back : between_[p - 1].back_up).asDiagonal();
        const bool last = p + 1 == rough_.size();
        k.block(at + upper, at + upper, lower, lower) =
            (last ? substrate_.back : between_[p].back_down).asDiagonal();
        if (!last) {
            // what goes down from here is worth what it is worth at the next interface, and back
            const Eigen::Index next = at + upper + lower;
            const Eigen::Index next_upper = rough_[p + 1].upper.cells();
            k.block(at + upper, next, lower, next_upper) = between_[p].down.transpose();
            k.block(next, at + upper, next_upper, lower) = between_[p].up.transpose();
        }
        at += upper + lower;
    }
    return k;
}

RoughResponse RoughSystem::solve() const {
    const Eigen::Index n = size();
    const Eigen::Index first_upper = rough_.front().upper.cells();
    const Eigen::Index last_lower = rough_.back().lower.cells();
    // values of outgoing flux: columns substrate, air; then values of incoming flux by the
    // interfaces' responses, with the share lost there as a third column
    Eigen::MatrixXd outgoing = Eigen::MatrixXd::Zero(n, 3);
    outgoing.col(0).tail(last_lower) = substrate_.through;
    outgoing.col(1).head(first_upper) = air_.through;
    Eigen::MatrixXd incoming(n, 3);
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd links = coupling();
    Eigen::Index at = 0;
    for (const Rough& rough : rough_) {
        const Eigen::Index m = rough.response.rows();
        const Eigen::MatrixXd adjoint = rough.response.transpose();
        incoming.middleRows(at, m) = adjoint * outgoing.middleRows(at, m);
        incoming.col(2).segment(at, m) =
            (1.0 - rough.response.colwise().sum().transpose().array()).max(0.0);
        system.middleRows(at, m) -= adjoint * links.middleRows(at, m);
        at += m;
    }
    if (!loses_) {
        incoming.col(2).setZero();
    }
    const bool coupled = (links.array() != 0.0).any();
    const Eigen::MatrixXd values = coupled ? system.partialPivLu().solve(incoming) : incoming;
    RoughResponse response;
    response.to_substrate = values.col(0).head(first_upper);
    response.to_air = values.col(1).head(first_upper);
    response.lost = values.col(2).head(first_upper);
    response.internal_reflectance =
        substrate_.emitted_back + substrate_.emitted.dot(values.col(0).tail(last_lower));
    response.escape = substrate_.emitted.dot(values.col(1).tail(last_lower));
    return response;
}

} // namespace reradiant
