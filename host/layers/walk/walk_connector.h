#pragma once

#include "host/layers/walk/walk_elements.h"
#include "host/layers/walk/walk_random.h"
#include "kernels/core/portable.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// A path from a direction in air down into a stack that only does what cannot be connected to:
/// refraction downwards and whatever is smooth. By reciprocity its weight at an element, over the
/// n^2 of the medium, is the radiance that leaves towards that direction per radiance that leaves
/// the element against the path.
struct WalkConnector {
    /// An arrival at an element to which light can be connected.
    struct Visit {
        std::size_t element;
        kernels::Vec3 d; ///< of travel
        Eigen::ArrayXd weight;
    };
    std::vector<Visit> visits;
};

/// `bands`: how many weights are carried, those of the slabs' tau.
WalkConnector connect_down(const WalkElements& elements, const kernels::Vec3& wo,
                           Eigen::Index bands, WalkRandom& random);

/// Henyey and Greenstein 1941, 1/sr, by the mean cosine g.
double henyey_greenstein(double g, double mu);
/// A direction scattered out of d, and rotated by that density.
kernels::Vec3 sample_henyey_greenstein(double g, const kernels::Vec3& d, WalkRandom& random);

/// Directions of travel in the frame of the side that a path arrives at, pointing back, and those
/// in which it leaves (host/layers/walk/walk_surface.h).
inline kernels::Vec3 arriving(const kernels::Vec3& d) {
    return d.z > 0.0 ? d : kernels::vec3(-d.x, -d.y, -d.z);
}
inline kernels::Vec3 leaving(const kernels::Vec3& w, bool below) {
    return below ? kernels::vec3(-w.x, -w.y, -w.z) : w;
}

/// Russian roulette below a weight of 1/50: what to multiply the path's weight by, 0 to end it.
double roulette(double weight, WalkRandom& random);

} // namespace reradiant
