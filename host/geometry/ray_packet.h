#pragma once

#include "host/geometry/embree_version.h"
#include "kernels/core/shared.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace reradiant {

/// Rays that Embree traces together, and where each belongs.
template <typename Rays>
class Packet {
public:
    bool is_full() const { return count_ == packet_rays; }
    bool is_empty() const { return count_ == 0; }
    int count() const { return count_; }
    std::uint32_t place(int k) const { return places_[static_cast<std::size_t>(k)]; }
    const int* valid() const { return valid_.data(); }
    Rays& rays() { return rays_; }

    void add(const RayRecord& r, std::uint32_t place) {
        RTCRay16& rays = rays_of(rays_);
        const auto k = static_cast<std::size_t>(count_++);
        rays.org_x[k] = r.origin_x;
        rays.org_y[k] = r.origin_y;
        rays.org_z[k] = r.origin_z;
        rays.tnear[k] = std::fmax(r.t_near, 0.0f);
        rays.dir_x[k] = r.direction_x;
        rays.dir_y[k] = r.direction_y;
        rays.dir_z[k] = r.direction_z;
        rays.tfar[k] = r.t_far;
        rays.time[k] = 0.0f;
        rays.mask[k] = 0xffffffffu;
        rays.flags[k] = 0;
        rays.id[k] = static_cast<unsigned int>(k);
        valid_[k] = -1;
        places_[k] = place;
    }
    void clear() {
        count_ = 0;
        valid_.fill(0);
    }

private:
    static RTCRay16& rays_of(RTCRay16& rays) { return rays; }
    static RTCRay16& rays_of(RTCRayHit16& rays) { return rays.ray; }

    Rays rays_;
    alignas(64) std::array<int, packet_rays> valid_{};
    std::array<std::uint32_t, packet_rays> places_{};
    int count_ = 0;
};

} // namespace reradiant
