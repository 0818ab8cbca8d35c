#include "host/layers/rough/interface_walk.h"

#include "host/layers/stack/microsurface.h"
#include "kernels/scatter/fresnel.h"

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

using microsurface::negated;

/// A `Facet` says how one facet reflects and refracts light that came from direction v (pointing
/// away from the surface).
struct Facet {
    double reflectance;
    Vec3 reflected; ///< in the frame of v's medium
    Vec3 refracted; ///< turned over, in the frame of the other medium: z > 0 leaves
};

Facet facet_response(const Vec3& v, const Vec3& h, double eta) {
    const double cos_i = std::max(kernels::vec3_dot(v, h), 0.0);
    const double cos_t = kernels::fresnel_cos_transmitted(cos_i, eta);
    Facet facet;
    facet.reflectance = kernels::fresnel_dielectric(cos_i, eta);
    facet.reflected = kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * cos_i), v);
    facet.refracted = kernels::vec3_sub(kernels::vec3_scale(v, 1.0 / eta),
                                        kernels::vec3_scale(h, cos_i / eta - cos_t));
    return facet;
}

/// Single scattering for a distribution sampled by microfacet_sample; returns the reflected share.
double scatter_once(const RoughInterface& interface, double eta, const Vec3& wi,
                    WalkNumbers& numbers, std::vector<Departure>& departures) {
    const int distribution = kernel_distribution(interface.distribution);
    const double u1 = numbers.next(), u2 = numbers.next();
    const Vec3 h = kernels::microfacet_sample(distribution, interface.alpha, wi, u1, u2);
    const double cos_i = kernels::vec3_dot(wi, h);
    if (cos_i <= 0.0)
        return 0.0;
    const Facet facet = facet_response(wi, h, eta);
    const bool blinn = interface.distribution == Distribution::Blinn;
    const double lambda_i = blinn ? 0.0 : microsurface::lambda(distribution, interface.alpha, wi);
    // share of the sampled facet's light that gets out: G2 over what the sampling accounts for
    const auto visible = [&](const Vec3& wo, double cos_o) {
        if (blinn) {
            const double g = std::min(
                {1.0, 2.0 * h.z * wo.z / std::max(cos_o, 1e-300), 2.0 * h.z * wi.z / cos_i});
            return g * cos_i / (wi.z * h.z);
        }
        return (1.0 + lambda_i) /
               (1.0 + lambda_i + microsurface::lambda(distribution, interface.alpha, wo));
    };
    double reflected = 0.0;
    if (facet.reflected.z > 0.0) {
        reflected = facet.reflectance * visible(facet.reflected, cos_i);
        departures.push_back({true, facet.reflected.z, reflected});
    }
    if (facet.refracted.z > 0.0 && facet.reflectance < 1.0) {
        const double cos_t = kernels::fresnel_cos_transmitted(cos_i, eta);
        departures.push_back({false, facet.refracted.z,
                              (1.0 - facet.reflectance) * visible(facet.refracted, cos_t)});
    }
    return reflected;
}

/// Walk on the microsurface. `height` is C of the frame's medium: 1 at the top as seen from it.
class SurfaceWalk {
public:
    SurfaceWalk(const RoughInterface& interface, double eta)
        : distribution_(kernel_distribution(interface.distribution)), alpha_(interface.alpha),
          eta_(eta) {}

    double run(const Vec3& wi, WalkNumbers& numbers, std::vector<Departure>& departures) {
        v_ = wi;
        const double lambda_i = lambda(wi);
        double first_lobe = 0.0;
        // order of the numbers: facet, then height, then the rest of the walk
        double u1 = numbers.next(), u2 = numbers.next();
        height_ = std::pow(1.0 - numbers.next(), 1.0 / (1.0 + lambda_i));
        for (int order = 1; weight_ > 0.0 && order <= 1000; ++order) {
            const Vec3 h = kernels::microfacet_sample(distribution_, alpha_, v_, u1, u2);
            const Facet facet = facet_response(v_, h, same_side_ ? eta_ : 1.0 / eta_);
            if (order == 1 && facet.reflected.z > 0.0) {
                first_lobe = facet.reflectance * (1.0 + lambda_i) /
                             (1.0 + lambda_i + lambda(facet.reflected));
            }
            leave_facet(facet, numbers, departures);
            u1 = numbers.next();
            u2 = numbers.next();
        }
        return first_lobe;
    }

private:
    double lambda(const Vec3& w) const { return microsurface::lambda(distribution_, alpha_, w); }

    double escape(const Vec3& w, double height) const {
        return microsurface::escape(distribution_, alpha_, w, height);
    }

    /// Scores both branches' departures and goes on along one of them.
    void leave_facet(const Facet& facet, WalkNumbers& numbers, std::vector<Departure>& departures) {
        const double below = 1.0 - height_;
        const double r = facet.reflectance, t = 1.0 - r;
        const double r_out = r > 0.0 ? escape(facet.reflected, height_) : 0.0;
        const double t_out = t > 0.0 ? escape(facet.refracted, below) : 0.0;
        if (r * r_out > 0.0)
            departures.push_back({same_side_, facet.reflected.z, weight_ * r * r_out});
        if (t * t_out > 0.0)
            departures.push_back({!same_side_, facet.refracted.z, weight_ * t * t_out});
        const double r_stays = r * (1.0 - r_out), t_stays = t * (1.0 - t_out);
        const double choice = numbers.next(), step = numbers.next();
        const double stays = r_stays + t_stays;
        weight_ *= stays;
        if (!survives(numbers)) {
            weight_ = 0.0;
            return;
        }
        if (choice * stays < r_stays) {
            advance(facet.reflected, height_, step);
        } else {
            same_side_ = !same_side_;
            advance(facet.refracted, below, step);
        }
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

    void advance(const Vec3& w, double height, double u) {
        height_ = microsurface::next_height(distribution_, alpha_, w, height, u);
        v_ = negated(w);
    }

    int distribution_;
    double alpha_, eta_;
    Vec3 v_{};
    double height_ = 1.0;
    double weight_ = 1.0;
    bool same_side_ = true;
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
    const double eta = from_below ? 1.0 / interface.eta : interface.eta;
    const Vec3 wi = kernels::vec3(std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, cosine);
    if (interface.scattering == Scattering::Single || interface.distribution == Distribution::Blinn)
        return scatter_once(interface, eta, wi, numbers, departures);
    return SurfaceWalk(interface, eta).run(wi, numbers, departures);
}

} // namespace reradiant
