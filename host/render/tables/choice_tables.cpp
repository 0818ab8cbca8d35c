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
    std::vector<double> shares;  ///< as append_choice names them
    double largest_albedo = 0.0; ///< over the lanes
};

/// Shares of the components of a material at one angle, mean over lanes.
class Components {
public:
    Components(const MaterialOptics& optics, const DiffuseShare& diffuse,
               const DiffuseShare& through, const RenderFeatures& features, int lanes, int phase)
        : optics_(optics), diffuse_(diffuse), through_(through), lobes_(features.lobes),
          count_(choice_count(features)), phase_(phase), residual_(residuals(optics, lanes, phase)),
          beside_(lanes) {
        for (int lane = 0; optics.is_sheet() && lane < lanes; ++lane)
            beside_(lane) = far_product(optics.sheet_at(phase, lane));
    }

    std::size_t count() const { return static_cast<std::size_t>(count_); }

    ComponentShares at(int node) const {
        ComponentShares result{std::vector<double>(count(), 0.0)};
        const auto lanes = static_cast<int>(residual_.size());
        for (int lane = 0; lane < lanes; ++lane) {
            std::vector<double> here(count(), 0.0);
            add_reflected(lane, node, here);
            if (optics_.is_sheet())
                add_through(lane, node, here);
            double sum = 0.0;
            for (const double share : here)
                sum += share;
            result.largest_albedo = std::max(result.largest_albedo, sum);
            for (std::size_t i = 0; i < here.size() && sum > 0.0; ++i)
                result.shares[i] += here[i] / (sum * lanes);
        }
        return result;
    }

private:
    /// Hemispherical share that the product form sends through, over its amplitude on this side.
    double far_product(const SheetTransmission& sheet) const {
        constexpr int points = 16;
        double sum = 0.0;
        for (int k = 0; k < points; ++k)
            sum +=
                sheet.product_amplitude(std::sqrt((k + 0.5) / points), opposite(optics_.side())) /
                points;
        return std::numbers::pi * sum;
    }

    void add_reflected(int lane, int node, std::vector<double>& here) const {
        const StackBsdf& o = optics_.at(phase_, lane);
        const double cosine = node_cosine(node);
        here.front() = o.delta(cosine);
        const std::vector<double> rough = o.lobe_shares(cosine);
        std::copy(rough.begin(), rough.end(), here.begin() + 1);
        here[2 + static_cast<std::size_t>(lobes_)] =
            diffuse_(lane, node) + o.residual_amplitude(cosine) * residual_(lane) +
            o.scattered_share(cosine);
    }

    void add_through(int lane, int node, std::vector<double>& here) const {
        const SheetTransmission& sheet = optics_.sheet_at(phase_, lane);
        const double cosine = node_cosine(node);
        const auto straight = 3 + static_cast<std::size_t>(lobes_);
        here[straight] = sheet.delta(cosine);
        here[straight + 1] = sheet.has_lobe() ? sheet.lobe_albedo(cosine, optics_.side()) : 0.0;
        here[straight + 2] = sheet.product_amplitude(cosine, optics_.side()) * beside_(lane) +
                             (through_ ? through_(lane, node) : 0.0);
    }

    const MaterialOptics& optics_;
    const DiffuseShare &diffuse_, &through_;
    int lobes_, count_, phase_;
    Eigen::VectorXd residual_, beside_;
};

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

DiffuseShare dyed_share(const ChannelOperator& dyes, Side from, Side to) {
    const auto lanes = static_cast<Eigen::Index>(dyes.reached.size());
    const Eigen::Index channels = dyes.coupling.rows() / lanes;
    Eigen::VectorXd entering = Eigen::VectorXd::Zero(channels * lanes);
    for (Eigen::Index lane = 0; lane < lanes; ++lane) {
        const Eigen::MatrixXd& reached = dyes.reached[static_cast<std::size_t>(lane)];
        for (Eigen::Index a = 0; a < reached.cols(); ++a)
            for (int node = 0; node + 1 < TABLE_NODES; ++node) { // trapezia in c^2
                const double low = node_cosine(node), high = node_cosine(node + 1);
                const Eigen::Index row = node_row(node, from);
                entering(a * lanes + lane) +=
                    0.5 * (high - low) * (high + low) * (reached(row, a) + reached(row + 1, a));
            }
    }
    const Eigen::VectorXd sent = std::numbers::pi * (dyes.coupling * entering);
    return [&dyes, lanes, sent, to](int lane, int node) {
        const Eigen::MatrixXd& reached = dyes.reached[static_cast<std::size_t>(lane)];
        double sum = 0.0;
        for (Eigen::Index b = 0; b < reached.cols(); ++b)
            sum += reached(node_row(node, to), b) * sent(b * lanes + lane);
        return std::max(sum, 0.0);
    };
}

std::uint32_t append_choice(const MaterialOptics& optics, const DiffuseShare& diffuse,
                            const DiffuseShare& through, const RenderFeatures& features,
                            LaneTables& lanes) {
    const Components components(optics, diffuse, through, features, lanes.lanes(),
                                lanes.phases() / 2);
    std::vector<ComponentShares> rows;
    std::vector<double> largest(components.count(), 0.0);
    for (int node = 0; node < TABLE_NODES; ++node) {
        rows.push_back(components.at(node));
        for (std::size_t i = 0; i < largest.size(); ++i)
            largest[i] = std::max(largest[i], rows.back().shares[i]);
    }
    // a black surface still chooses
    const auto cosine = 2 + static_cast<std::size_t>(features.lobes);
    largest[cosine] = std::max(largest[cosine], 1e-300);
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
