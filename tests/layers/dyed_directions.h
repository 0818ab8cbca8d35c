#pragma once

#include "tests/layers/dyed_balance.h"
#include "tests/layers/walk_parts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

/// Values of dyed stacks and sheets in directions, by adding and by the walk.
namespace reradiant::test {

struct DyedCase {
    std::string name;
    LayerStack stack;
    Eigen::MatrixXd substrate = Eigen::MatrixXd::Zero(3, 3); ///< of sheets without meaning
    bool is_spread = false; ///< by rough faces or clouds: unshifted light has approximate lobes
};

/// Three dyed stacks over a substrate and three sheets: clear, cloudy and rough.
inline std::vector<DyedCase> dyed_cases() {
    const std::vector<double> shares{.1, 0, 0, .4, .2, 0, .2, .5, .3};
    const Eigen::MatrixXd ground = matrix_of_three({.3, 0, 0, .3, .5, 0, .1, .3, .8});
    Layer clear = dyed_layer(1.5, {.8, .3, 0}, shares);
    clear.absorption = Spectrum::constant(0.05);
    Layer cloud = dyed_layer(1.4, {.5, .2, .1}, shares), rough = clear;
    cloud.scattering_coefficient = Spectrum::constant(2.0);
    cloud.anisotropy = 0.5;
    rough.alpha = 0.3;
    return {{"clear over a fluorescent ground", {{clear}}, ground},
            {"cloudy beneath clear, over the same", {{clear, cloud}}, ground, true},
            {"rough (alpha 0.3), over the same", {{rough}}, ground, true},
            {"clear sheet", {{clear}, LowerFace{}}},
            {"cloudy sheet", {{cloud}, LowerFace{}}, {}, true},
            {"rough sheet (alpha 0.3, 0.2)", {{rough}, LowerFace{.alpha = 0.2}}, {}, true}};
}

/// A value in a pair of directions, 1/sr, from one band to another.
struct DyedPair {
    double theta_i_deg, theta_o_deg;
    int emission, excitation;
    double adding, walk, error; ///< of the walk
    double z() const { return (adding - walk) / error; }
    /// What the models differ by, of the walk's value.
    double relative() const { return std::fabs(adding - walk) / walk; }
};

/// Compares both models at 0, 45 and 75 degrees, out of the plane of incidence, of sheets on both
/// sides for light from above: shifted bands, or those that light keeps.
inline std::vector<DyedPair> compare_in_directions(const DyedCase& one, bool shifted,
                                                   std::uint64_t walks, std::uint64_t seed) {
    const LayeredBsdf bsdf = adding_of(one.stack, one.substrate);
    const LayerWalk walk = walk_of(one.stack, one.substrate);
    std::vector<double> thetas{0, 45, 75};
    if (one.stack.is_sheet())
        thetas.insert(thetas.end(), {105, 135, 180});
    std::vector<kernels::Vec3> directions;
    for (const double theta : thetas)
        directions.push_back(direction_deg(theta, 60));
    std::vector<DyedPair> pairs;
    for (const double theta_i : {0.0, 45.0, 75.0}) {
        const kernels::Vec3 wi = direction_deg(theta_i);
        const WalkEstimate found = estimate_walk(walk, wi, directions, walks, seed++);
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const Eigen::MatrixXd adding = bsdf.eval(wi, directions[k]);
            const Eigen::MatrixXd mean = all_light(found.mean.directional[k]);
            const Eigen::MatrixXd error = all_errors(found.standard_error.directional[k]);
            for (int i = 0; i < 3; ++i)
                for (int o = shifted ? i + 1 : i; o < (shifted ? 3 : i + 1); ++o)
                    if (adding(o, i) > 0.0 || mean(o, i) > 0.0)
                        pairs.push_back(
                            {theta_i, thetas[k], o, i, adding(o, i), mean(o, i), error(o, i)});
        }
    }
    return pairs;
}

/// What both models differ by over all pairs.
struct DyedDifference {
    DyedPair worst_by_z{};
    DyedPair worst_beyond{}; ///< of those whose |z| is above a bound; `walk` is 0 where none is
    double mean = 0.0, mean_error = 0.0; ///< relative
    int beyond = 0;
};

inline DyedDifference difference_of(const std::vector<DyedPair>& pairs, double bound) {
    DyedDifference found{pairs.front(), {}};
    for (const DyedPair& pair : pairs) {
        found.mean += pair.relative() / static_cast<double>(pairs.size());
        found.mean_error += pair.error / pair.walk / static_cast<double>(pairs.size());
        if (std::fabs(pair.z()) > std::fabs(found.worst_by_z.z()))
            found.worst_by_z = pair;
        if (std::fabs(pair.z()) <= bound)
            continue;
        ++found.beyond;
        if (found.worst_beyond.walk == 0.0 || pair.relative() > found.worst_beyond.relative())
            found.worst_beyond = pair;
    }
    return found;
}

} // namespace reradiant::test
