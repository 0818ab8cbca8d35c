#include "host/layers/angular/angular_system.h"

#include "host/spectral/matrix/linear_systems.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

AngularSystem::AngularSystem(std::span<const StackElement> stack) {
    std::vector<SmoothStack> piles; // above and between the scatterers
    std::size_t first = 0;          // of the run of elements since the last scatterer
    double ior = 1.0;               // of the medium beneath that
    for (std::size_t k = 0; k < stack.size(); ++k) {
        if (!scatters(stack[k]))
            continue;
        piles.push_back(smooth_pile(ior, stack.subspan(first, k - first)));
        if (const auto* slab = std::get_if<SlabValues>(&stack[k]))
            scatterers_.push_back(scatterer_of(*slab));
        else
            add_interface(std::get<SurfaceValues>(stack[k]));
        first = k + 1;
        ior = scatterers_.back().lower.ior;
    }
    for (std::size_t p = 0; p + 1 < scatterers_.size(); ++p) {
        between_.push_back(
            pile_between(piles[p + 1], scatterers_[p].lower, scatterers_[p + 1].upper));
    }
    top_media_ = piles.front();
    bottom_media_ = smooth_pile(ior, stack.subspan(first));
    air_ = air_pile(top_media_, scatterers_.front().upper);
}

void AngularSystem::add_interface(const SurfaceValues& interface) {
    if (scatterers_.empty() && interface.ior_below >= interface.ior_above) {
        const auto op = operator_of(interface);
        const Eigen::Index n = op->above.cells();
        const Eigen::MatrixXd shares = op->exchange * op->etendue().cwiseInverse().asDiagonal();
        first_lobe_ = op->first_lobe;
        between_facets_ =
            (shares.topLeftCorner(n, n).colwise().sum().transpose() - first_lobe_).cwiseMax(0.0);
    }
    scatterers_.push_back(scatterer_of(interface));
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

Eigen::MatrixXd AngularSystem::values_of(const Eigen::MatrixXd& outgoing,
                                         const Eigen::MatrixXd& links) const {
    const Eigen::Index n = size();
    Eigen::MatrixXd incoming = Eigen::MatrixXd::Zero(n, 1 + outgoing.cols());
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n);
    Eigen::Index at = 0;
    for (const Scatterer& scatterer : scatterers_) {
        const Eigen::Index m = scatterer.response.rows();
        const Eigen::MatrixXd adjoint = scatterer.response.transpose();
        incoming.block(at, 1, m, outgoing.cols()) = adjoint * outgoing.middleRows(at, m);
        if (scatterer.loses) {
            incoming.col(0).segment(at, m) =
                (1.0 - scatterer.response.colwise().sum().transpose().array()).max(0.0);
        }
        system.middleRows(at, m) -= adjoint * links.middleRows(at, m);
        at += m;
    }
    const bool coupled = (links.array() != 0.0).any();
    return coupled ? left_quotient(system, incoming) : incoming;
}

namespace {

AngularShares shares_of(const Eigen::MatrixXd& values) {
    return {values.col(1), values.col(2), values.col(0)};
}

} // namespace

AngularResponse AngularSystem::solve() const {
    const SubstratePile substrate =
        substrate_pile(bottom_media_, scatterers_.back().lower, CosineNodes(1));
    const Eigen::Index first_upper = scatterers_.front().upper.cells();
    const Eigen::Index last_lower = scatterers_.back().lower.cells();
    // values of outgoing flux: columns substrate, air
    Eigen::MatrixXd outgoing = Eigen::MatrixXd::Zero(size(), 2);
    outgoing.col(0).tail(last_lower) = substrate.through.col(0);
    outgoing.col(1).head(first_upper) = air_.through;
    const Eigen::MatrixXd links = coupling(substrate);
    const Eigen::MatrixXd values = values_of(outgoing, links);
    AngularResponse response;
    response.incoming = shares_of(values.topRows(first_upper));
    if (scatterers_.front().depth > 0.0) {
        const Eigen::Index below = scatterers_.front().lower.cells();
        Eigen::MatrixXd passed = links.middleRows(first_upper, below) * values;
        passed.rightCols(2) += outgoing.middleRows(first_upper, below);
        response.passed = shares_of(passed);
    }
    response.internal_reflectance =
        substrate.emitted_back(0, 0) + substrate.emitted.col(0).dot(values.col(1).tail(last_lower));
    response.escape = substrate.emitted.col(0).dot(values.col(2).tail(last_lower));
    return response;
}

Eigen::MatrixXd AngularSystem::returned(const CosineNodes& nodes) const {
    const SubstratePile substrate = substrate_pile(bottom_media_, scatterers_.back().lower, nodes);
    const Eigen::Index last_lower = scatterers_.back().lower.cells();
    Eigen::MatrixXd outgoing = Eigen::MatrixXd::Zero(size(), nodes.size());
    outgoing.bottomRows(last_lower) = substrate.through;
    const Eigen::MatrixXd values = values_of(outgoing, coupling(substrate));
    return substrate.emitted_back +
           substrate.emitted.transpose() * values.bottomRows(last_lower).rightCols(nodes.size());
}

} // namespace reradiant
