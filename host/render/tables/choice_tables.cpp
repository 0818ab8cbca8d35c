#include "host/render/tables/choice_tables.h"

#include "kernels/core/shared.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// Every component that exists keeps at least this share of the samples.
constexpr double least_choice = 0.05;

/// 2 integral value(c) c dc by the midpoint rule in c^2.
double cosine_mean(const StackBsdf& optics, double (StackBsdf::*value)(double) const) {
    constexpr int points = 16;
    double sum = 0.0;
    for (int k = 0; k < points; ++k)
        sum += (optics.*value)(std::sqrt((k + 0.5) / points)) / points;
    return sum;
}

/// A `CosineLobe` holds, per lane, the size of the two components that the cosine lobe stands for.
struct CosineLobe {
    Eigen::VectorXd diffuse;  ///< hemispherical exitance under uniform white light, over T out
    Eigen::VectorXd residual; ///< albedo of the residual, over its value
};

CosineLobe cosine_lobe(const MaterialOptics& optics, const LaneOperator& substrate, int phase) {
    Eigen::VectorXd entering(substrate.diagonal.size()), residual(substrate.diagonal.size());
    for (Eigen::Index lane = 0; lane < entering.size(); ++lane) {
        const StackBsdf& o = optics.at(phase, static_cast<int>(lane));
        entering(lane) = cosine_mean(o, &StackBsdf::transmission);
        residual(lane) = std::numbers::pi * cosine_mean(o, &StackBsdf::residual_amplitude);
    }
    return {std::numbers::pi * substrate.row_sums().cwiseProduct(entering), residual};
}

struct ComponentShares {
    std::vector<double> shares;  ///< delta, top, deeper lobes, diffuse
    double largest_albedo = 0.0; ///< over the lanes
};

/// Each component's share of what is reflected at one angle, mean over lanes.
ComponentShares component_shares(const MaterialOptics& optics, const CosineLobe& lobe, int phase,
                                 int lobes, double cosine) {
    ComponentShares result{std::vector<double>(static_cast<std::size_t>(3 + lobes), 0.0)};
    const auto lanes = static_cast<int>(lobe.diffuse.size());
    for (int lane = 0; lane < lanes; ++lane) {
        const StackBsdf& o = optics.at(phase, lane);
        std::vector<double> here(result.shares.size(), 0.0);
        here.front() = o.delta(cosine);
        const std::vector<double> rough = o.lobe_shares(cosine);
        std::copy(rough.begin(), rough.end(), here.begin() + 1);
        here.back() = o.transmission(cosine) * lobe.diffuse(lane) +
                      o.residual_amplitude(cosine) * lobe.residual(lane) +
                      o.scattered_share(cosine);
        double sum = 0.0;
        for (const double share : here)
            sum += share;
        result.largest_albedo = std::max(result.largest_albedo, sum);
        for (std::size_t i = 0; i < here.size() && sum > 0.0; ++i)
            result.shares[i] += here[i] / (sum * lanes);
    }
    return result;
}

} // namespace

std::uint32_t append_choice(const MaterialOptics& optics, const LaneOperator& substrate, int lobes,
                            LaneTables& lanes) {
    const int phase = lanes.phases() / 2;
    const CosineLobe lobe = cosine_lobe(optics, substrate, phase);
    std::vector<ComponentShares> rows;
    std::vector<double> largest(static_cast<std::size_t>(3 + lobes), 0.0);
    for (int node = 0; node < TABLE_NODES; ++node) {
        rows.push_back(component_shares(optics, lobe, phase, lobes, node_cosine(node)));
        for (std::size_t i = 0; i < largest.size(); ++i)
            largest[i] = std::max(largest[i], rows.back().shares[i]);
    }
    largest.back() = std::max(largest.back(), 1e-300); // a black surface still chooses
    const std::uint32_t offset = lanes.here();
    for (ComponentShares& row : rows) {
        double sum = 0.0;
        for (std::size_t i = 0; i < largest.size(); ++i) {
            row.shares[i] = largest[i] > 0.0 ? std::max(row.shares[i], least_choice) : 0.0;
            sum += row.shares[i];
        }
        double cumulative = 0.0;
        for (std::size_t i = 0; i < largest.size(); ++i) {
            cumulative += row.shares[i] / sum;
            lanes.append(i + 1 < largest.size() ? cumulative : 1.0);
        }
        lanes.append(std::min(1.0, row.largest_albedo));
    }
    return offset;
}

} // namespace reradiant
