#include "host/layers/angular/angular_system.h"

#include "host/layers/angular/scattering_slab.h"
#include "host/layers/rough/interface_operator.h"

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

AngularSystem::AngularSystem(const StackValues& stack, std::size_t count) {
    std::vector<SmoothStack> piles; // above, between and below the scatterers
    std::size_t first_medium = 0;
    for (std::size_t k = 0; k < count; ++k) {
        if (is_rough_interface(stack, k)) {
            piles.push_back(smooth_media(stack, first_medium, k));
            add_interface(stack, k);
            first_medium = k + 1;
        }
        if (stack[k].tau_scattering > 0.0) {
            piles.push_back(smooth_media(stack, first_medium, k + 1));
            add_slab(stack[k]);
            first_medium = k + 1;
        }
    }
    for (std::size_t p = 0; p + 1 < scatterers_.size(); ++p) {
        between_.push_back(
            pile_between(piles[p + 1], scatterers_[p].lower, scatterers_[p + 1].upper));
    }
    top_media_ = piles.front();
    bottom_media_ = smooth_media(stack, first_medium, count);
    air_ = air_pile(top_media_, scatterers_.front().upper);
}

void AngularSystem::add_slab(const LayerValues& layer) {
    const double n = layer.ior;
    const double critical = n > 1.0 ? std::sqrt((n - 1.0) * (n + 1.0)) / n : 0.0;
    const AngularGrid grid = make_angular_grid(n, critical, interface_cells);
    const SlabOperator slab =
        scattering_slab(grid, layer.tau, layer.tau_scattering, layer.anisotropy);
    Scatterer scatterer{grid, grid, Eigen::MatrixXd(2 * grid.cells(), 2 * grid.cells())};
    scatterer.response << slab.back, slab.through, slab.through, slab.back;
    scatterer.depth = layer.tau + layer.tau_scattering;
    scatterers_.push_back(std::move(scatterer));
}

void AngularSystem::add_interface(const StackValues& stack, std::size_t index) {
    const LayerValues& layer = stack[index];
    const double above = index == 0 ? 1.0 : stack[index - 1].ior;
    const bool denser = layer.ior >= above;
    const double ratio = denser ? layer.ior / above : above / layer.ior;
    const auto op = interface_operator({ratio, layer.distribution, layer.alpha, layer.scattering});
    const Eigen::VectorXd e = op->etendue();
    const Eigen::MatrixXd shares = op->exchange * e.cwiseInverse().asDiagonal();
    const Eigen::Index n = op->above.cells();
    Scatterer rough{op->above, op->below, shares, layer.scattering == Scattering::Single};
    if (!denser) { // the operator is stored thinner side first; the surface looks alike from below
        std::swap(rough.upper, rough.lower);
        rough.response << shares.bottomRightCorner(n, n), shares.bottomLeftCorner(n, n),
            shares.topRightCorner(n, n), shares.topLeftCorner(n, n);
    }
    rough.upper.ior = above;
    rough.lower.ior = layer.ior;
    if (scatterers_.empty() && denser)
        first_lobe_ = op->first_lobe;
    scatterers_.push_back(std::move(rough));
}

Eigen::Index AngularSystem::size() const {
    Eigen::Index n = 0;
    for (const Scatterer& scatterer : scatterers_)
        n += scatterer.response.rows();
    return n;
}

Eigen::MatrixXd AngularSystem::coupling(const SubstratePile& substrate) const {
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(size(), size());
    Eigen::Index at = 0;
    for (std::size_t p = 0; p < scatterers_.size(); ++p) {
        const Eigen::Index upper = scatterers_[p].upper.cells(),
                           lower = scatterers_[p].lower.cells();
        k.block(at, at, upper, upper) = (p == 0 ? air_.back : between_[p - 1].back_up).asDiagonal();
        const bool last = p + 1 == scatterers_.size();
        k.block(at + upper, at + upper, lower, lower) =
            (last ? substrate.back : between_[p].back_down).asDiagonal();
        if (!last) {
            // what goes down from here is worth what it is worth at the next scatterer, and back
            const Eigen::Index next = at + upper + lower;
            const Eigen::Index next_upper = scatterers_[p + 1].upper.cells();
            k.block(at + upper, next, lower, next_upper) = between_[p].down.transpose();
            k.block(next, at + upper, next_upper, lower) = between_[p].up.transpose();
        }
        at += upper + lower;
    }
    return k;
}

namespace {

AngularShares shares_of(const Eigen::MatrixXd& values) {
    return {values.col(0), values.col(1), values.col(2)};
}

} // namespace

AngularResponse AngularSystem::solve(const SubstrateWeight& weight) const {
    const SubstratePile substrate = substrate_pile(bottom_media_, scatterers_.back().lower, weight);
    const Eigen::Index n = size();
    const Eigen::Index first_upper = scatterers_.front().upper.cells();
    const Eigen::Index last_lower = scatterers_.back().lower.cells();
    // values of outgoing flux: columns substrate, air; then values of incoming flux by the
    // scatterers' responses, with the share lost there as a third column
    Eigen::MatrixXd outgoing = Eigen::MatrixXd::Zero(n, 3);
    outgoing.col(0).tail(last_lower) = substrate.through;
    outgoing.col(1).head(first_upper) = air_.through;
    Eigen::MatrixXd incoming = Eigen::MatrixXd::Zero(n, 3);
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd links = coupling(substrate);
    Eigen::Index at = 0;
    for (const Scatterer& scatterer : scatterers_) {
        const Eigen::Index m = scatterer.response.rows();
        const Eigen::MatrixXd adjoint = scatterer.response.transpose();
        incoming.middleRows(at, m) = adjoint * outgoing.middleRows(at, m);
        if (scatterer.loses) {
            incoming.col(2).segment(at, m) =
                (1.0 - scatterer.response.colwise().sum().transpose().array()).max(0.0);
        }
        system.middleRows(at, m) -= adjoint * links.middleRows(at, m);
        at += m;
    }
    const bool coupled = (links.array() != 0.0).any();
    const Eigen::MatrixXd values = coupled ? system.partialPivLu().solve(incoming) : incoming;
    AngularResponse response;
    response.incoming = shares_of(values.topRows(first_upper));
    if (scatterers_.front().depth > 0.0) {
        const Eigen::Index below = scatterers_.front().lower.cells();
        response.passed = shares_of(outgoing.middleRows(first_upper, below) +
                                    links.middleRows(first_upper, below) * values);
    }
    response.internal_reflectance =
        substrate.emitted_back + substrate.emitted.dot(values.col(0).tail(last_lower));
    response.escape = substrate.emitted.dot(values.col(1).tail(last_lower));
    return response;
}

} // namespace reradiant
