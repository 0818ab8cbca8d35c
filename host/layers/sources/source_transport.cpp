#include "host/layers/sources/source_transport.h"

#include "host/layers/sources/angular_sources.h"
#include "host/layers/sources/smooth_sources.h"
#include "host/layers/stack/quadrature.h"
#include "host/layers/stack/stack_check.h"

#include <algorithm>
#include <numbers>

namespace reradiant {

const Eigen::VectorXd& SourceTransport::escaped(Side to) const {
    Escaped& known = escaped_[to == Side::Above ? 0 : 1];
    std::call_once(known.made, [&] { known.share = integrate_escaped(to); });
    return known.share;
}

Eigen::VectorXd SourceTransport::escaped_by_reciprocity(const std::vector<double>& breaks,
                                                        Side to) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(sources());
    for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
        const double scale = std::numbers::pi * (breaks[piece + 1] - breaks[piece]);
        for_sin2_nodes(
            breaks[piece], breaks[piece + 1], escape_nodes,
            [&](double c, double weight) { sum += scale * weight * c * reached(c, to); });
    }
    return sum.cwiseQuotient(weights_);
}

std::shared_ptr<const SourceTransport> source_transport(const StackElements& stack,
                                                        const StackCells& cells) {
    check_stack(stack);
    if (std::none_of(stack.begin(), stack.end(), scatters))
        return smooth_sources(stack, cells);
    return angular_sources(stack, cells);
}

} // namespace reradiant
