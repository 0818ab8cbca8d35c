#include "host/layers/rough/interface_walk.h"

#include "kernels/walk/walk_microsurface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace reradiant {

using kernels::Vec3;

namespace {

/// PCG output function (O'Neill 2014) of three counters, in [0, 1).
double hashed_uniform(unsigned walk, unsigned stream, unsigned dimension) {
    std::uint32_t state = stream;
    for (const std::uint32_t counter : {walk, dimension, 0U}) {
        state = (state + counter) * 747796405U + 2891336453U;
        state = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
        state = (state >> 22U) ^ state;
    }
    return state * 0x1p-32;
}

/// The facets that are seen from one side.
kernels::WalkSurface facets_of(const RoughInterface& interface, double eta) {
    const bool multiple = interface.scattering == Scattering::Multiple;
    return {
        kernel_distribution(interface.distribution), interface.alpha, eta, multiple, 0, nullptr};
}

/// A `Facet` says how one facet reflects and refracts light that came from direction v (pointing
/// away from the surface).
struct Facet {
    Vec3 h;
    double cos_i, reflectance;
    Vec3 reflected; ///< in the frame of v's medium
    Vec3 refracted; ///< turned over, in the frame of the other medium: z > 0 leaves
};

Facet facet_response(const kernels::WalkSurface& facets, const Vec3& v, const Vec3& h) {
    Facet facet{};
    facet.h = h;
    facet.cos_i = kernels::vec3_dot(v, facet.h);
    facet.reflectance = kernels::walk_reflectance(facets, std::max(facet.cos_i, 0.0));
    facet.reflected = kernels::walk_reflected(v, facet.h);
    facet.refracted = kernels::vec3_scale(kernels::walk_refracted(v, facet.h, facets.eta), -1.0);
    return facet;
}

/// Single scattering; returns the reflected share.
double scatter_once(const kernels::WalkSurface& facets, const Vec3& wi, WalkNumbers& numbers,
                    std::vector<Departure>& departures) {
    const double u1 = numbers.next(), u2 = numbers.next(), u = numbers.next();
    const Facet facet =
        facet_response(facets, wi, kernels::walk_sample_facet(facets, wi, u1, u2, u));
    if (facet.cos_i <= 0.0)
        return 0.0;
    const auto leaves = [&](double share, const Vec3& wo) {
        return share *
               kernels::walk_single_share(facets, wi, facet.h, wo, kernels::vec3_dot(wo, facet.h));
    };
    double reflected = 0.0;
    if (facet.reflected.z > 0.0) {
        reflected = leaves(facet.reflectance, facet.reflected);
        departures.push_back({true, facet.reflected.z, reflected});
    }
    if (facet.refracted.z > 0.0 && facet.reflectance < 1.0) {
        departures.push_back(
            {false, facet.refracted.z, leaves(1.0 - facet.reflectance, facet.refracted)});
    }
    return reflected;
}

/// Walk on the microsurface.
class SurfaceWalk {
public:
    double run(const kernels::WalkSurface& facets, const Vec3& wi, WalkNumbers& numbers,
               std::vector<Departure>& departures) {
        double first_lobe = 0.0;
        // order of the numbers: facet, then height, then the rest of the walk
        double u1 = numbers.next(), u2 = numbers.next();
        walk_ = kernels::walk_between_facets(facets, wi, numbers.next());
        while (weight_ > 0.0 && walk_.order < 1000) {
            const kernels::WalkSurface& seen = walk_.surface;
            const Facet facet = facet_response(
                seen, walk_.v,
                kernels::microfacet_sample(seen.distribution, seen.alpha, walk_.v, u1, u2));
            if (walk_.order == 0 && facet.reflected.z > 0.0) {
                first_lobe =
                    facet.reflectance *
                    kernels::walk_single_share(facets, wi, facet.h, facet.reflected, facet.cos_i);
            }
            leave_facet(facet, numbers, departures);
            u1 = numbers.next();
            u2 = numbers.next();
        }
        return first_lobe;
    }

private:
    /// Scores both branches' departures and goes on along one of them.
    void leave_facet(const Facet& facet, WalkNumbers& numbers, std::vector<Departure>& departures) {
        const bool same_side = walk_.passed == 0;
        const double r = facet.reflectance, t = 1.0 - r;
        const double r_out = r > 0.0 ? escape(facet.reflected, walk_.height) : 0.0;
        const double t_out = t > 0.0 ? escape(facet.refracted, 1.0 - walk_.height) : 0.0;
        if (r * r_out > 0.0)
            departures.push_back({same_side, facet.reflected.z, weight_ * r * r_out});
        if (t * t_out > 0.0)
            departures.push_back({!same_side, facet.refracted.z, weight_ * t * t_out});
        const double r_stays = r * (1.0 - r_out), t_stays = t * (1.0 - t_out);
        const double choice = numbers.next(), step = numbers.next();
        const double stays = r_stays + t_stays;
        weight_ *= stays;
        if (!survives(numbers)) {
            weight_ = 0.0;
            return;
        }
        const bool reflects = choice * stays < r_stays;
        if (!reflects)
            kernels::walk_pass_facet(&walk_);
        const Vec3& w = reflects ? facet.reflected : facet.refracted;
        kernels::walk_meet_facet(&walk_, w,
                                 kernels::walk_met_height(walk_.surface, w, walk_.height, step));
    }

    double escape(const Vec3& w, double height) const {
        return kernels::walk_escape(walk_.surface, w, height);
    }

    /// Russian roulette below a weight of 1/100.
    bool survives(WalkNumbers& numbers) {
        constexpr double floor = 0.01;
        if (weight_ >= floor)
            return true;
        if (numbers.next() * floor >= weight_)
            return false;
        weight_ = floor;
        return true;
    }

    kernels::WalkBetweenFacets walk_{};
    double weight_ = 1.0;
};

} // namespace

LatticeRule lattice_rule(const RoughInterface& interface) {
    // generators: 220 is the best of 400 by the P2 figure of merit (Sloan and Joe 1994, section
    // 4) in 12 dimensions with weights 0.6^d; 5130 as in L'Ecuyer and Lemieux 2000, table 1
    const bool walks = interface.scattering == Scattering::Multiple &&
                       interface.distribution != Distribution::Blinn;
    return walks ? LatticeRule{4093, 220} : LatticeRule{8191, 5130};
}

WalkStream::WalkStream(const LatticeRule& rule, unsigned stream_seed) : seed(stream_seed) {
    std::uint64_t power = 1;
    for (unsigned d = 0; d < dimensions; ++d) {
        generator[d] = static_cast<double>(power) / rule.count;
        shift[d] = hashed_uniform(~0U, seed, d);
        power = power * rule.generator % rule.count;
    }
}

double WalkNumbers::next() {
    const unsigned d = dimension_++;
    if (d >= WalkStream::dimensions)
        return hashed_uniform(walk_, stream_.seed, d);
    const double x = walk_ * stream_.generator[d] + stream_.shift[d];
    return x - static_cast<double>(static_cast<unsigned>(x));
}

double scatter_at_interface(const RoughInterface& interface, bool from_below, double cosine,
                            WalkNumbers& numbers, std::vector<Departure>& departures) {
    const kernels::WalkSurface facets =
        facets_of(interface, from_below ? 1.0 / interface.eta : interface.eta);
    const Vec3 wi = kernels::vec3(std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, cosine);
    if (interface.scattering == Scattering::Single || interface.distribution == Distribution::Blinn)
        return scatter_once(facets, wi, numbers, departures);
    return SurfaceWalk().run(facets, wi, numbers, departures);
}

} // namespace reradiant
