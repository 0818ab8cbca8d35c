#pragma once

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// A `WalkTally` holds the estimates, by band, that one walk or the mean over many walks gives for
/// a material. Light that may leave in another band than it came in has the shape (bands, bands),
/// rows = emission; other light has (bands, 1), the diagonal.
struct WalkTally {
    /// Light by what it has met. `diffuse` reached the substrate: full where that or a dye
    /// fluoresces. `slab` did not, but was scattered or re-emitted in a slab: full where a slab
    /// holds dyes. `specular` was neither.
    struct Parts {
        Eigen::MatrixXd diffuse, slab;
        Eigen::VectorXd specular;
    };
    Parts hemispherical;            ///< unit 1, deltas included: on the side where the light came
    Parts transmitted;              ///< the same on a sheet's other side; else without entries
    std::vector<Parts> directional; ///< 1/sr without cosine, deltas left out, one a direction asked
    Eigen::MatrixXd guided;         ///< share that clear slabs hold for ever; shaped as `slab`
    Eigen::VectorXd delta;          ///< share that smooth surfaces alone send back
    Eigen::VectorXd delta_transmitted; ///< share that smooth surfaces alone let through a sheet
    Eigen::VectorXd lost;              ///< share that single scattering loses before the substrate

    void set_zero();
};

/// Calls f(array) for every array of the parts.
template <typename Parts, typename Function>
void for_parts(Parts& parts, const Function& f) {
    f(parts.diffuse);
    f(parts.slab);
    f(parts.specular);
}

/// Returns all light of the parts together: (bands, bands), rows = emission.
Eigen::MatrixXd all_light(const WalkTally::Parts& parts);

/// Calls f(array) for every array of a tally, always in one order.
template <typename Tally, typename Function>
void for_arrays(Tally& tally, const Function& f) {
    for_parts(tally.hemispherical, f);
    for_parts(tally.transmitted, f);
    for (auto& parts : tally.directional)
        for_parts(parts, f);
    f(tally.guided);
    f(tally.delta);
    f(tally.delta_transmitted);
    f(tally.lost);
}

} // namespace reradiant
