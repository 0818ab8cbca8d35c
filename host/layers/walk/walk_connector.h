#pragma once

#include "host/layers/walk/walk_elements.h"
#include "host/layers/walk/walk_random.h"
#include "host/layers/walk/walk_throughput.h"
#include "kernels/core/portable.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace reradiant {

/// A `WalkConnector` is a path from a direction in air into a stack, down or, from beneath a sheet,
/// up. It takes only events that need no value: refraction inwards, the way it came in, and
/// whatever is smooth. By reciprocity its weight at an element, divided by the n^2 of the medium,
/// is the radiance that leaves towards that direction per radiance that leaves the element against
/// the path.
struct WalkConnector {
    /// An arrival at an element to which light can be connected.
    struct Visit {
        std::size_t element;
        kernels::Vec3 d; ///< direction of travel
        Eigen::ArrayXd weight;
    };
    bool from_above = true;
    std::vector<Visit> visits;

    bool goes_inwards(const Visit& visit) const { return (visit.d.z < 0.0) == from_above; }
};

/// Follows a path inwards from wo. `bands` is the number of weights that it carries, one for each
/// entry of the slabs' tau.
WalkConnector connect_inwards(const WalkElements& elements, const kernels::Vec3& wo,
                              Eigen::Index bands, WalkRandom& random);

/// `WalkConnectors` makes the paths from the directions asked for when they are first needed.
class WalkConnectors {
public:
    WalkConnectors(std::span<const kernels::Vec3> wo, std::uint64_t seed, std::uint64_t sample)
        : wo_(wo), seed_(seed), sample_(sample) {}

    std::size_t size() const { return wo_.size(); }
    /// Returns the paths in the band that a walk is in, one a direction.
    const std::vector<WalkConnector>& of(const WalkThroughput& carried);

private:
    std::span<const kernels::Vec3> wo_;
    std::uint64_t seed_, sample_;
    int band_ = 0;
    std::vector<WalkConnector> made_;
};

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
