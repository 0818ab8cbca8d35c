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

/// Albedo of the residual, over its value, by lane.
Eigen::VectorXd residuals(const MaterialOptics& optics, int lanes, int phase) {
    Eigen::VectorXd residual(lanes);
    for (int lane = 0; lane < lanes; ++lane)
        residual(lane) =
            std::numbers::pi * cosine_mean(optics.at(phase, lane), &StackBsdf::residual_amplitude);
    return residual;
}

struct ComponentShares {
    std::vector<double> shares;  ///< delta, top, deeper lobes, diffuse
    double largest_albedo = 0.0; ///< over the lanes
};

/// Each component's share of what is reflected at one angle, mean over lanes.
ComponentShares component_shares(const MaterialOptics& optics, const DiffuseShare& diffuse,
                                 const Eigen::VectorXd& residual, int phase, int lobes, int node) {
    ComponentShares result{std::vector<double>(static_cast<std::size_t>(3 + lobes), 0.0)};
    const auto lanes = static_cast<int>(residual.size());
    const double cosine = node_cosine(node);
    for (int lane = 0; lane < lanes; ++lane) {
        const StackBsdf& o = optics.at(phase, lane);
        std::vector<double> here(result.shares.size(), 0.0);
        here.front() = o.delta(cosine);
        const std::vector<double> rough = o.lobe_shares(cosine);
        std::copy(rough.begin(), rough.end(), here.begin() + 1);
        here.back() = diffuse(lane, node) + o.residual_amplitude(cosine) * residual(lane) +
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

DiffuseShare substrate_share(const MaterialOptics& optics, const LaneOperator& substrate,
                             int phase) {
    Eigen::VectorXd entering(substrate.diagonal.size());
    for (Eigen::Index lane = 0; lane < entering.size(); ++lane)
        entering(lane) =
            cosine_mean(optics.at(phase, static_cast<int>(lane)), &StackBsdf::transmission);
    const Eigen::VectorXd sent = std::numbers::pi * substrate.row_sums().cwiseProduct(entering);
    return [&optics, phase, sent](int lane, int node) {
        return optics.at(phase, lane).transmission(node_cosine(node)) * sent(lane);
    };
}

DiffuseShare dyed_share(const ChannelOperator& dyes) {
    const auto lanes = static_cast<Eigen::Index>(dyes.reached.size());
    const Eigen::Index channels = dyes.coupling.rows() / lanes;
    Eigen::VectorXd entering = Eigen::VectorXd::Zero(channels * lanes);
    for (Eigen::Index lane = 0; lane < lanes; ++lane) {
        const Eigen::MatrixXd& reached = dyes.reached[static_cast<std::size_t>(lane)];
        for (Eigen::Index a = 0; a < reached.cols(); ++a)
            for (int node = 0; node + 1 < TABLE_NODES; ++node) { // trapezia in c^2
                const double low = node_cosine(node), high = node_cosine(node + 1);
                entering(a * lanes + lane) +=
                    0.5 * (high - low) * (high + low) * (reached(node, a) + reached(node + 1, a));
            }
    }
    const Eigen::VectorXd sent = std::numbers::pi * (dyes.coupling * entering);
    return [&dyes, lanes, sent](int lane, int node) {
        const Eigen::MatrixXd& reached = dyes.reached[static_cast<std::size_t>(lane)];
        double sum = 0.0;
        for (Eigen::Index b = 0; b < reached.cols(); ++b)
            sum += reached(node, b) * sent(b * lanes + lane);
        return std::max(sum, 0.0);
    };
}

std::uint32_t append_choice(const MaterialOptics& optics, const DiffuseShare& diffuse, int lobes,
                            LaneTables& lanes) {
    const int phase = lanes.phases() / 2;
    const Eigen::VectorXd residual = residuals(optics, lanes.lanes(), phase);
    std::vector<ComponentShares> rows;
    std::vector<double> largest(static_cast<std::size_t>(3 + lobes), 0.0);
    for (int node = 0; node < TABLE_NODES; ++node) {
        rows.push_back(component_shares(optics, diffuse, residual, phase, lobes, node));
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
