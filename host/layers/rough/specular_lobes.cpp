#include "host/layers/rough/specular_lobes.h"

#include "host/layers/rough/interface_walk.h"
#include "kernels/scatter/facet_shape.h"
#include "kernels/scatter/lobe_ratio.h"
#include "kernels/scatter/lobe_width.h"
#include "kernels/scatter/microfacet.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

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
    const double value = at(i) + t * (slope0 + t * ((3.0 * rise - 2.0 * slope0 - slope1) +
                                                    t * (slope0 + slope1 - 2.0 * rise)));
    return std::max(value, 0.0); // beside a kink a cubic dips below
}

namespace {

/// Facets a node: enough for an amplitude, whose shortfall goes to the residual. Generator as in
/// L'Ecuyer and Lemieux 2000, table 1.
constexpr LatticeRule lobe_rule{1021, 76}, deeper_rule{4093, 1516};

double table_ratio(const LobeShape& lobe, const Vec3& wi, const Vec3& wo) {
    if (!lobe.table)
        return 1.0;
    const auto ratio = [&](const Vec3& first, const Vec3& second) {
        return kernels::lobe_ratio_value(lobe.table->data(), sampling_width(lobe, 1.0), first,
                                         second);
    };
    switch (lobe.table_kind) {
    case LobeShape::Table::OwnFirst:
        return ratio(wi, wo);
    case LobeShape::Table::OwnSecond:
        return ratio(wo, wi);
    case LobeShape::Table::Sum:
        return ratio(wi, wo) + ratio(wo, wi);
    case LobeShape::Table::Facets:
        break;
    }
    return kernels::facet_shape_value(lobe.table->data(), lobe.alpha, wi, wo);
}

/// Share of a unit lobe's flux without Fresnel, one sample of the visible facets of a width: G2 /
/// G1 where that is the lobe's own.
double lobe_share(const LobeShape& lobe, double sampled, const Vec3& wi, const Vec3& wo,
                  const Vec3& h) {
    const int distribution = kernel_distribution(lobe.distribution);
    const double width = lobe_width(lobe, wi.z, wo.z);
    const double density = width == sampled ? 1.0
                                            : kernels::microfacet_d(distribution, width, h) /
                                                  kernels::microfacet_d(distribution, sampled, h);
    const double g2 = kernels::microfacet_g2_over_cosines(distribution, width, wi, wo, h);
    if (distribution == MICROFACET_BLINN)
        return density * g2 * wo.z * kernels::vec3_dot(wi, h) / h.z;
    const double own = wi.z + kernels::microfacet_lambda_cos(distribution, sampled, wi);
    return density * own * wo.z * g2;
}

/// K(i, o): albedo of the lobe at node i that comes from amplitudes at node o.
Eigen::MatrixXd spread_matrix(const LobeShape& lobe) {
    const int distribution = kernel_distribution(lobe.distribution);
    const LatticeRule rule = lobe.ior > 0.0 ? deeper_rule : lobe_rule;
    const WalkStream stream(rule, 0);
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(CosineTable::nodes, CosineTable::nodes);
    for (int node = 0; node < CosineTable::nodes; ++node) {
        const double c = std::max(CosineTable::node_cosine(node), 1e-6);
        const Vec3 wi = kernels::vec3(std::sqrt((1.0 - c) * (1.0 + c)), 0.0, c);
        // wider than the lobe, whose width changes with the other direction
        const double width = sampling_width(lobe, c);
        const double sampled = lobe.ior > 0.0 ? std::min(1.3 * width, 1.0) : width;
        for (unsigned sample = 0; sample < rule.count; ++sample) {
            WalkNumbers numbers(stream, sample);
            const double u1 = numbers.next(), u2 = numbers.next();
            const Vec3 h = kernels::microfacet_sample(distribution, sampled, wi, u1, u2);
            const double cos_h = kernels::vec3_dot(wi, h);
            const Vec3 wo = kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * cos_h), wi);
            if (cos_h <= 0.0 || wo.z <= 0.0)
                continue;
            const double share =
                lobe_share(lobe, sampled, wi, wo, h) * table_ratio(lobe, wi, wo) / rule.count;
            const double x = std::sqrt(std::min(wo.z, 1.0)) * (CosineTable::nodes - 1);
            const int left = std::min(static_cast<int>(x), CosineTable::nodes - 2);
            spread(node, left) += share * (left + 1 - x);
            spread(node, left + 1) += share * (x - left);
        }
    }
    return spread;
}

/// What spreads depend on.
auto key_of(const LobeShape& lobe) {
    std::vector<double> numbers{lobe.alpha, lobe.ior};
    for (const LobePassage& p : lobe.passages)
        numbers.insert(numbers.end(), {p.alpha, p.ior_above, p.ior_below});
    return std::tuple{lobe.distribution, std::move(numbers), lobe.table, lobe.table_kind};
}

std::shared_ptr<const Eigen::MatrixXd> spread_of(const LobeShape& lobe) {
    static std::mutex mutex;
    static std::map<decltype(key_of(lobe)), std::shared_ptr<const Eigen::MatrixXd>> known;
    const std::scoped_lock lock(mutex);
    auto& spread = known[key_of(lobe)];
    if (!spread)
        spread = std::make_shared<Eigen::MatrixXd>(spread_matrix(lobe));
    return spread;
}

std::vector<double> as_vector(const Eigen::VectorXd& v) {
    return {v.data(), v.data() + v.size()};
}

Eigen::VectorXd at_nodes(const std::function<double(double cosine)>& wanted) {
    Eigen::VectorXd values(CosineTable::nodes);
    for (int node = 0; node < CosineTable::nodes; ++node)
        values(node) = std::max(wanted(CosineTable::node_cosine(node)), 0.0);
    return values;
}

/// Lowers amplitudes where the lobe would hold more than `target`; `unscaled` is its albedo without
/// them.
void lower_to(const Eigen::VectorXd& target, const Eigen::VectorXd& unscaled, Eigen::VectorXd& a) {
    const Eigen::VectorXd reached = a.cwiseProduct(unscaled);
    for (Eigen::Index i = 0; i < a.size(); ++i)
        a(i) *= reached(i) > target(i) ? target(i) / reached(i) : 1.0;
}

LobeTables tables_of(const Eigen::VectorXd& amplitude, const Eigen::VectorXd& albedo) {
    return {CosineTable(as_vector(amplitude)), CosineTable(as_vector(albedo))};
}

} // namespace

double lobe_width(const LobeShape& lobe, double cos_i, double cos_o) {
    if (lobe.ior == 0.0)
        return lobe.alpha;
    const double sin2_i = (1.0 - cos_i) * (1.0 + cos_i), sin2_o = (1.0 - cos_o) * (1.0 + cos_o);
    const int distribution = kernel_distribution(lobe.distribution);
    double terms = kernels::lobe_width_term(
        distribution, lobe.alpha * (kernels::lobe_width_normal(lobe.ior, sin2_i) +
                                    kernels::lobe_width_normal(lobe.ior, sin2_o)));
    for (const LobePassage& p : lobe.passages)
        for (const double sin2 : {sin2_i, sin2_o})
            terms += kernels::lobe_width_term(
                distribution, kernels::lobe_width_passage(p.alpha, p.ior_above, p.ior_below, sin2));
    return kernels::lobe_width(distribution, terms, cos_i, cos_o);
}

double lobe_value(const LobeShape& lobe, const Vec3& wi, const Vec3& wo) {
    return kernels::microfacet_reflection(kernel_distribution(lobe.distribution),
                                          lobe_width(lobe, wi.z, wo.z), wi, wo) *
           table_ratio(lobe, wi, wo);
}

CosineTable lobe_albedo(const LobeShape& lobe) {
    return CosineTable(as_vector(spread_of(lobe)->rowwise().sum()));
}

LobeTables fit_lobe(const LobeShape& lobe, const std::function<double(double cosine)>& wanted) {
    const std::shared_ptr<const Eigen::MatrixXd> spread = spread_of(lobe);
    // a little below what is there, so that interpolation does not overshoot it and the residual
    // takes the rest; a lobe with a table stands for all
    const Eigen::VectorXd target = (lobe.table ? 1.0 : 0.998) * at_nodes(wanted);
    Eigen::VectorXd a = target.cwiseSqrt();
    for (int step = 0; step < 12; ++step) {
        const Eigen::VectorXd albedo = a.cwiseProduct(*spread * a);
        for (Eigen::Index i = 0; i < a.size(); ++i) {
            a(i) = albedo(i) > 0.0 ? a(i) * std::sqrt(target(i) / albedo(i)) : 0.0;
            // where the lobe loses its light below the horizon no amplitude is enough
            a(i) = std::min(a(i), lobe.table ? 2.0 : 1.0);
        }
    }
    lower_to(target, *spread * a, a);
    return tables_of(a, a.cwiseProduct(*spread * a));
}

std::array<LobeTables, 2> fit_lobes(const std::array<LobeShape, 2>& lobes,
                                    const std::array<std::function<double(double)>, 2>& wanted) {
    constexpr double largest = 2.0;
    const std::shared_ptr<const Eigen::MatrixXd> spreads[2] = {spread_of(lobes[0]),
                                                               spread_of(lobes[1])};
    const Eigen::VectorXd targets[2] = {at_nodes(wanted[0]), at_nodes(wanted[1])};
    Eigen::VectorXd a[2] = {targets[0].cwiseSqrt(), targets[1].cwiseSqrt()};
    for (int step = 0; step < 24; ++step)
        for (const std::size_t own : {0U, 1U}) {
            const Eigen::VectorXd unscaled = *spreads[own] * a[1 - own];
            for (Eigen::Index i = 0; i < unscaled.size(); ++i)
                a[own](i) =
                    unscaled(i) > 0.0 ? std::min(targets[own](i) / unscaled(i), largest) : 0.0;
        }
    for (const std::size_t own : {0U, 1U})
        lower_to(targets[own], *spreads[own] * a[1 - own], a[own]);
    return {tables_of(a[0], a[0].cwiseProduct(*spreads[0] * a[1])),
            tables_of(a[1], a[1].cwiseProduct(*spreads[1] * a[0]))};
}

LobeShape deeper_lobe(std::span<const StackElement> stack, std::size_t element) {
    const SurfaceValues& own = std::get<SurfaceValues>(stack[element]);
    LobeShape lobe;
    lobe.alpha = own.alpha;
    lobe.ior = own.ior_above;
    lobe.element = element;
    for (const StackElement& above : stack.first(element)) {
        const auto* surface = std::get_if<SurfaceValues>(&above);
        if (surface && surface->alpha > 0.0)
            lobe.passages.push_back({surface->alpha, surface->ior_above, surface->ior_below});
    }
    return lobe;
}

} // namespace reradiant
