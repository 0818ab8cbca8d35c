#include "host/fit/dye/depth_table.h"

#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// depth = largest * s * weight(s) / weight(1) for s in 0..1: cubic, but of finite slope at zero.
constexpr double linear_part = 1e-3;

double weight(double s) {
    return linear_part + s * s;
}

double depth_of(double s, double largest) {
    return largest * s * weight(s) / weight(1.0);
}

/// The one real root of s^3 + d s = q, by hyperbolic functions.
double place_of(double depth, double largest) {
    const double q = weight(1.0) * depth / largest, third = linear_part / 3.0;
    return 2.0 * std::sqrt(third) *
           std::sinh(std::asinh(1.5 * q / (linear_part * std::sqrt(third))) / 3.0);
}

double node(int k) {
    return std::cos(std::numbers::pi * (k + 0.5) / DepthTable::nodes);
}

Eigen::VectorXd packed(const SourceTransport& transport, const std::vector<DyeView>& views) {
    const Eigen::Index n = transport.sources(), count = static_cast<Eigen::Index>(views.size());
    Eigen::VectorXd all(n * (n + 2 * count));
    all.head(n * n) = transport.exchange().reshaped();
    for (Eigen::Index v = 0; v < count; ++v) {
        const DyeView& view = views[static_cast<std::size_t>(v)];
        all.segment(n * (n + v), n) = transport.reached(view.from.cosine, view.from.side);
        all.segment(n * (n + count + v), n) =
            view.cosine
                ? Eigen::VectorXd(
                      transport.reached(*view.cosine, view.seen).cwiseQuotient(transport.weights()))
                : transport.escaped(view.seen);
    }
    return all;
}

} // namespace

std::vector<double> DepthTable::node_depths(double largest_depth) {
    std::vector<double> depths;
    for (int k = 0; k < nodes; ++k)
        depths.push_back(depth_of(0.5 * (1.0 + node(k)), largest_depth));
    return depths;
}

DepthTable::DepthTable(double largest_depth,
                       std::span<const std::shared_ptr<const SourceTransport>> by_node,
                       const std::vector<DyeView>& views)
    : largest_depth_(largest_depth), sources_(by_node.front()->sources()),
      views_(static_cast<Eigen::Index>(views.size())) {
    Eigen::MatrixXd values(sources_ * (sources_ + 2 * views_), nodes);
    Eigen::MatrixXd transform(nodes, nodes);
    for (int k = 0; k < nodes; ++k) {
        values.col(k) =
            weight(0.5 * (1.0 + node(k))) * packed(*by_node[static_cast<std::size_t>(k)], views);
        for (int j = 0; j < nodes; ++j)
            transform(k, j) =
                (j == 0 ? 1.0 : 2.0) / nodes * std::cos(j * std::numbers::pi * (k + 0.5) / nodes);
    }
    coefficients_ = values * transform;
}

DepthTransport DepthTable::unpacked(const Eigen::VectorXd& packed) const {
    const Eigen::Index n = sources_;
    return {packed.head(n * n).reshaped(n, n),
            packed.segment(n * n, n * views_).reshaped(n, views_),
            packed.tail(n * views_).reshaped(n, views_)};
}

DepthTransportPair DepthTable::at(double depth) const {
    const bool is_beyond = depth >= largest_depth_;
    const double s = is_beyond ? 1.0 : place_of(depth, largest_depth_), x = 2.0 * s - 1.0;
    Eigen::VectorXd t(nodes), u(nodes); // polynomials and their derivatives
    t(0) = 1.0;
    t(1) = x;
    u(0) = 0.0;
    u(1) = 1.0;
    for (int j = 2; j < nodes; ++j) {
        t(j) = 2.0 * x * t(j - 1) - t(j - 2);
        u(j) = 2.0 * t(j - 1) + 2.0 * x * u(j - 1) - u(j - 2);
    }
    const double w = weight(s);
    const double slope_of_place =
        is_beyond ? 0.0 : weight(1.0) / (largest_depth_ * (linear_part + 3.0 * s * s));
    const Eigen::VectorXd slope = slope_of_place * (2.0 / w * u - 2.0 * s / (w * w) * t);
    return {unpacked(coefficients_ * (t / w)), unpacked(coefficients_ * slope)};
}

StackElements with_dye(StackElements elements, std::size_t slab_element, double depth) {
    auto& slab = std::get<SlabValues>(elements[slab_element]);
    slab.tau += depth;
    slab.tau_dyes += depth;
    return elements;
}

} // namespace reradiant
