#include "host/layers/rough/facet_orders.h"

#include "host/layers/rough/interface_walk.h"
#include "kernels/walk/walk_microsurface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace reradiant {

using kernels::Vec3;

namespace {

constexpr unsigned orders = 24;
/// Share of the light whose further meetings are not followed.
constexpr double negligible = 1e-4;
/// Generator as in L'Ecuyer and Lemieux 2000, table 1.
constexpr LatticeRule walk_rule{1021, 76};

/// Adds what one walk sends out after every meeting but the first, which it does not score.
void add_walk(const kernels::WalkSurface& facets, const Vec3& wi, WalkNumbers numbers,
              Eigen::Ref<Eigen::RowVectorXd> shares) {
    kernels::WalkBetweenFacets walk = kernels::walk_between_facets(facets, wi, numbers.next());
    double weight = 1.0;
    while (walk.order < orders && weight > negligible) {
        const double u1 = numbers.next(), u2 = numbers.next();
        const Vec3 h =
            kernels::microfacet_sample(facets.distribution, facets.alpha, walk.v, u1, u2);
        const Vec3 out = kernels::walk_reflected(walk.v, h);
        const double leaves = weight * kernels::walk_escape(facets, out, walk.height);
        if (walk.order > 0)
            shares(walk.order - 1) += leaves;
        weight -= leaves;
        kernels::walk_meet_facet(
            &walk, out, kernels::walk_met_height(facets, out, walk.height, numbers.next()));
    }
    shares(walk.order - 1) += weight;
}

Eigen::MatrixXd walked_orders(const LobeShape& lobe) {
    const WalkStream stream(walk_rule, 0);
    const kernels::WalkSurface facets{
        kernel_distribution(lobe.distribution), lobe.alpha, 1.0, 1, 1, nullptr};
    const CosineTable once = lobe_albedo(lobe);
    Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(CosineTable::nodes, orders);
    for (int node = 0; node < CosineTable::nodes; ++node) {
        const double c = std::max(CosineTable::node_cosine(node), 1e-6);
        const Vec3 wi = kernels::vec3(std::sqrt((1.0 - c) * (1.0 + c)), 0.0, c);
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(orders);
        for (unsigned walk = 0; walk < walk_rule.count; ++walk)
            add_walk(facets, wi, WalkNumbers(stream, walk), row);
        // the lobe is known better than by these walks
        const double rest = std::max(1.0 - once.values()[static_cast<std::size_t>(node)], 0.0);
        shares.row(node) = row.sum() > 0.0 ? Eigen::RowVectorXd(row * (rest / row.sum())) : row;
    }
    return shares;
}

} // namespace

std::shared_ptr<const Eigen::MatrixXd> facet_orders(const LobeShape& lobe) {
    static std::mutex mutex;
    static std::map<std::pair<Distribution, double>, std::shared_ptr<const Eigen::MatrixXd>> known;
    const std::scoped_lock lock(mutex);
    auto& shares = known[{lobe.distribution, lobe.alpha}];
    if (!shares)
        shares = std::make_shared<Eigen::MatrixXd>(walked_orders(lobe));
    return shares;
}

} // namespace reradiant
