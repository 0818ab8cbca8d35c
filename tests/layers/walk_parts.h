#pragma once

#include "host/layers/stack/slab_emission.h"
#include "host/layers/walk/walk_estimate.h"
#include "tests/layers/slab_cases.h"
#include "tests/support/full_run.h"

#include <Eigen/Core>

#include <cstdint>

/// Walks at the three bands of the slab cases, and what their parts add up to.
namespace reradiant::test {

inline std::uint64_t samples(std::uint64_t count) {
    return test::is_full_run() ? 16 * count : count;
}

inline LayerWalk walk_of(const LayerStack& stack,
                         const Eigen::MatrixXd& substrate = Eigen::MatrixXd::Zero(3, 3)) {
    return LayerWalk(stack, {.matrix = substrate}, three_bands.centres_nm(),
                     slab_emissions(stack, three_bands));
}

/// A layer of one index, width and absorption at all wavelengths.
inline Layer plain_layer(double ior, double alpha, Distribution distribution,
                         double absorption = 0.0) {
    Layer layer;
    layer.ior = Spectrum::constant(ior);
    layer.alpha = alpha;
    layer.distribution = distribution;
    layer.absorption = Spectrum::constant(absorption);
    return layer;
}

/// Standard errors of all_light.
inline Eigen::MatrixXd all_errors(WalkTally::Parts parts) {
    for_parts(parts, [](auto& part) { part = part.cwiseAbs2().eval(); });
    return all_light(parts).cwiseSqrt();
}

/// What the columns add up to on both sides and within.
inline Eigen::VectorXd column_sums(const WalkTally& tally) {
    Eigen::MatrixXd sum = all_light(tally.hemispherical) + tally.guided;
    if (tally.transmitted.specular.size() > 0)
        sum += all_light(tally.transmitted);
    return sum.colwise().sum();
}

} // namespace reradiant::test
