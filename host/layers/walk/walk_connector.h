#pragma once

#include "host/layers/walk/walk_elements.h"
#include "host/layers/walk/walk_random.h"
#include "kernels/core/portable.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// A `WalkConnector` is a path from a direction in air down into a stack. It takes only events that
/// cannot be connected to: refraction downwards and whatever is smooth. By reciprocity its weight
/// at an element, divided by the n^2 of the medium, is the radiance that leaves towards that
/// direction per radiance that leaves the element against the path.
struct WalkConnector {
    /// An arrival at an element to which light can be connected.
    struct Visit {
        std::size_t element;
        kernels::Vec3 d; ///< direction of travel
        Eigen::ArrayXd weight;
    };
    std::vector<Visit> visits;
};

/// Follows a path down from wo. `bands` is the number of weights that it carries, one for each
/// entry of the slabs' tau.
WalkConnector connect_down(const WalkElements& elements, const kernels::Vec3& wo,
                           Eigen::Index bands, WalkRandom& random);

/// These convert directions of travel into the frame of one side of a surface
/// (host/layers/walk/walk_surface.h): `arriving` into that of the side that a path arrives at,
/// pointing back, and `leaving` from that of the side on which it leaves.
inline kernels::Vec3 arriving(const kernels::Vec3& d) {
    return d.z > 0.0 ? d : kernels::vec3(-d.x, -d.y, -d.z);
}
inline kernels::Vec3 leaving(const kernels::Vec3& w, bool below) {
    return below ? kernels::vec3(-w.x, -w.y, -w.z) : w;
}

/// Plays Russian roulette below a weight of 1/50: returns the factor for the weight of the path, 0
/// to end it.
double roulette(double weight, WalkRandom& random);

} // namespace reradiant
