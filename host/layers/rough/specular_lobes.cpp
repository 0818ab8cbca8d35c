#include "host/layers/rough/specular_lobes.h"

#include "host/layers/rough/interface_walk.h"
#include "kernels/scatter/microfacet.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace reradiant {

using kernels::Vec3;

double CosineTable::node_cosine(int node) {
    const double x = static_cast<double>(node) / (nodes - 1);
    return x * x;
}

double CosineTable::operator()(double cosine) const {
    const double x = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * (nodes - 1);
    const int i = std::min(static_cast<int>(x), nodes - 2);
    const double t = x - i;
    const auto at = [&](int k) { return values_[static_cast<std::size_t>(k)]; };
    // Catmull-Rom, one-sided at the ends
    const double slope0 = i > 0 ? 0.5 * (at(i + 1) - at(i - 1)) : at(1) - at(0);
    const double slope1 = i + 2 < nodes ? 0.5 * (at(i + 2) - at(i)) : at(i + 1) - at(i);
    const double rise = at(i + 1) - at(i);
    return at(i) + t * (slope0 + t * ((3.0 * rise - 2.0 * slope0 - slope1) +
                                      t * (slope0 + slope1 - 2.0 * rise)));
}

namespace {

/// Facets a node: enough for an amplitude, whose shortfall goes to the residual. Generator as in
/// L'Ecuyer and Lemieux 2000, table 1.
constexpr LatticeRule lobe_rule{1021, 76};

/// Share of a unit lobe's flux without Fresnel, one sample of the visible facets: G2 / G1.
double lobe_share(int distribution, double alpha, const Vec3& wi, const Vec3& wo, const Vec3& h) {
    if (distribution == MICROFACET_BLINN) {
        return kernels::microfacet_g2(distribution, alpha, wi, wo, h) * kernels::vec3_dot(wi, h) /
               (wi.z * h.z);
    }
    const double own = wi.z + kernels::microfacet_lambda_cos(distribution, alpha, wi);
    return own * wo.z * kernels::microfacet_g2_over_cosines(distribution, alpha, wi, wo, h);
}

/// K(i, o): albedo of the lobe at node i that comes from amplitudes at node o.
Eigen::MatrixXd spread_matrix(const LobeShape& lobe) {
    const int distribution = kernel_distribution(lobe.distribution);
    const WalkStream stream(lobe_rule, 0);
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(CosineTable::nodes, CosineTable::nodes);
    for (int node = 0; node < CosineTable::nodes; ++node) {
        const double c = std::max(CosineTable::node_cosine(node), 1e-6);
        const Vec3 wi = kernels::vec3(std::sqrt((1.0 - c) * (1.0 + c)), 0.0, c);
        for (unsigned sample = 0; sample < lobe_rule.count; ++sample) {
            WalkNumbers numbers(stream, sample);
            const double u1 = numbers.next(), u2 = numbers.next();
            const Vec3 h = kernels::microfacet_sample(distribution, lobe.alpha, wi, u1, u2);
            const double cos_h = kernels::vec3_dot(wi, h);
            const Vec3 wo = kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * cos_h), wi);
            if (cos_h <= 0.0 || wo.z <= 0.0)
                continue;
            const double share = lobe_share(distribution, lobe.alpha, wi, wo, h) / lobe_rule.count;
            const double x = std::sqrt(std::min(wo.z, 1.0)) * (CosineTable::nodes - 1);
            const int left = std::min(static_cast<int>(x), CosineTable::nodes - 2);
            spread(node, left) += share * (left + 1 - x);
            spread(node, left + 1) += share * (x - left);
        }
    }
    return spread;
}

std::shared_ptr<const Eigen::MatrixXd> spread_of(const LobeShape& lobe) {
    static std::mutex mutex;
    static std::map<std::pair<int, double>, std::shared_ptr<const Eigen::MatrixXd>> known;
    const std::pair<int, double> key{static_cast<int>(lobe.distribution), lobe.alpha};
    const std::scoped_lock lock(mutex);
    auto& spread = known[key];
    if (!spread)
        spread = std::make_shared<Eigen::MatrixXd>(spread_matrix(lobe));
    return spread;
}

std::vector<double> as_vector(const Eigen::VectorXd& v) {
    return {v.data(), v.data() + v.size()};
}

} // namespace

CosineTable lobe_albedo(const LobeShape& lobe) {
    return CosineTable(as_vector(spread_of(lobe)->rowwise().sum()));
}

LobeTables fit_lobe(const LobeShape& lobe, const std::function<double(double cosine)>& wanted) {
    const std::shared_ptr<const Eigen::MatrixXd> spread = spread_of(lobe);
    Eigen::VectorXd target(CosineTable::nodes);
    for (int node = 0; node < CosineTable::nodes; ++node) {
        // a little below what is there, so that interpolation does not overshoot it
        target(node) = 0.998 * std::max(wanted(CosineTable::node_cosine(node)), 0.0);
    }
    Eigen::VectorXd a = target.cwiseSqrt();
    for (int step = 0; step < 12; ++step) {
        const Eigen::VectorXd albedo = a.cwiseProduct(*spread * a);
        for (Eigen::Index i = 0; i < a.size(); ++i) {
            a(i) = albedo(i) > 0.0 ? a(i) * std::sqrt(target(i) / albedo(i)) : 0.0;
            // where the lobe loses its light below the horizon no amplitude is enough
            a(i) = std::min(a(i), 1.0);
        }
    }
    const Eigen::VectorXd reached = a.cwiseProduct(*spread * a);
    for (Eigen::Index i = 0; i < a.size(); ++i)
        a(i) *= reached(i) > target(i) ? target(i) / reached(i) : 1.0;
    const Eigen::VectorXd albedo = a.cwiseProduct(*spread * a);
    return {CosineTable(as_vector(a)), CosineTable(as_vector(albedo))};
}

double effective_lobe_width(std::span<const StackElement> stack, std::size_t element) {
    const SurfaceValues& own = std::get<SurfaceValues>(stack[element]);
    double variance = own.ior_above * own.alpha * own.ior_above * own.alpha;
    for (const StackElement& above : stack.first(element))
        if (const auto* surface = std::get_if<SurfaceValues>(&above)) {
            const double bend = (surface->ior_below / surface->ior_above - 1.0) * surface->alpha;
            variance += 0.5 * bend * bend;
        }
    const double steps = std::round(std::sqrt(variance) * 4096.0);
    return std::clamp(steps, 4.0, 4096.0) / 4096.0;
}

} // namespace reradiant
