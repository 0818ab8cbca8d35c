#pragma once

#include "host/layers/stack/slab_emission.h"
#include "host/layers/walk/walk_estimate.h"
#include "host/measure/measure_substrate.h"
#include "tests/render/walk_strips.h"
#include "tests/support/directions.h"

/// What the renderer's walk is compared with: the walk of `measure`, in double precision.
namespace reradiant::test {

/// Radiance of each band, with its variance.
struct WalkedTruth {
    Eigen::VectorXd value, variance;
};

/// Returns the radiance that leaves along wo under light of one unit of irradiance per nm from wi.
inline WalkedTruth walked_truth(const Material& material, const kernels::Vec3& wi,
                                const kernels::Vec3& wo) {
    const LayerWalk walk(material.stack, measured_substrate(material.substrate, bands),
                         bands.centres_nm(), slab_emissions(material.stack, bands));
    const WalkEstimate found =
        estimate_walk(walk, wi, {&wo, 1}, is_full_run() ? 1u << 19 : 1u << 13, 3);
    WalkTally::Parts errors = found.standard_error.directional[0];
    for_parts(errors, [](auto& part) { part = part.cwiseAbs2().eval(); });
    return {std::fabs(wi.z) * all_light(found.mean.directional[0]).rowwise().sum(),
            wi.z * wi.z * all_light(errors).rowwise().sum()};
}

} // namespace reradiant::test
