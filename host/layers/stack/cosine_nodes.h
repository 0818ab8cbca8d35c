#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace reradiant {

/// Shares of the two nodes that a cosine lies between; their sum is 1.
struct CosineShare {
    Eigen::Index below;
    double above_share; ///< of the node after it

    /// Calls visit(node, share) for those with a share.
    template <typename Visit>
    void for_nodes(const Visit& visit) const {
        if (above_share < 1.0)
            visit(below, 1.0 - above_share);
        if (above_share > 0.0)
            visit(below + 1, above_share);
    }
};

/// Nodes uniform in the cosine over [0, 1], between which functions are linear. A single one stands
/// for constants.
class CosineNodes {
public:
    explicit CosineNodes(Eigen::Index count) : count_(count) {}

    Eigen::Index size() const { return count_; }
    double cosine(Eigen::Index node) const {
        return static_cast<double>(node) / static_cast<double>(count_ - 1);
    }
    CosineShare at(double cosine) const {
        if (count_ == 1)
            return {0, 0.0};
        const double position = std::clamp(cosine, 0.0, 1.0) * static_cast<double>(count_ - 1);
        const Eigen::Index below = std::min(static_cast<Eigen::Index>(position), count_ - 2);
        return {below, position - static_cast<double>(below)};
    }

private:
    Eigen::Index count_;
};

} // namespace reradiant
