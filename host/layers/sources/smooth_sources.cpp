#include "host/layers/sources/smooth_sources.h"

#include "host/layers/sources/ray_stack.h"
#include "host/layers/stack/directions.h"
#include "host/layers/stack/quadrature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

constexpr int nodes_per_piece = 48;

class SmoothSources final : public SourceTransport {
public:
    SmoothSources(const StackElements& stack, const StackCells& cells)
        : rays_(1.0, stack, cells), breaks_(reradiant::breaks_in_air(stack)) {
        weights_ = rays_.weights();
        RayExchange sums{Eigen::MatrixXd::Zero(rays_.sources(), rays_.sources()),
                         Eigen::VectorXd::Zero(rays_.sources())};
        std::vector<double> media = rays_.media();
        std::sort(media.begin(), media.end());
        double below = 0.0; // IOR where the piece begins: q = below^2
        for (const double n : media) {
            add_piece(below, n, sums);
            below = n;
        }
        exchange_ = sums.between * weights_.cwiseInverse().asDiagonal();
        guided_ = sums.guided.cwiseQuotient(weights_);
    }

    Eigen::VectorXd reached(double cos_theta, Side from) const override {
        const double c = std::clamp(cos_theta, 0.0, 1.0);
        RayResponse response = rays_.at(1.0, c * c);
        return from == Side::Above ? response.from_above : response.from_below;
    }

protected:
    Eigen::VectorXd integrate_escaped(Side to) const override {
        return escaped_by_reciprocity(breaks_, to);
    }

private:
    /// Integrates q from n^2 of one medium to that of the next; the latter is the reference, in
    /// which g^2 = n^2 - q cancels nothing. By g^2 = w sin^4 u nodes are dense where light grazes:
    /// there thin cells absorb within a small range of cosines.
    void add_piece(double from, double to, RayExchange& sums) const {
        const double width = (to - from) * (to + from), half_pi = 0.5 * std::numbers::pi;
        if (!(width > 1e-14))
            return;
        const Quadrature& rule = gauss_legendre(nodes_per_piece);
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double s = std::sin(half_pi * rule.nodes[i]);
            const double c = std::cos(half_pi * rule.nodes[i]);
            rays_.at(to, width * s * s * s * s,
                     half_pi * width * rule.weights[i] * 4.0 * s * s * s * c, &sums);
        }
    }

    RayStack rays_;
    std::vector<double> breaks_;
};

} // namespace

std::shared_ptr<const SourceTransport> smooth_sources(const StackElements& stack,
                                                      const StackCells& cells) {
    return std::make_shared<SmoothSources>(stack, cells);
}

} // namespace reradiant
