#include "host/layers/walk/walk_surface.h"

#include "host/layers/stack/microsurface.h"
#include "host/layers/stack/quadrature.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/thin_film.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

/// Directional scattering of the facets that are seen from one side of a surface.
class FacetLobes {
public:
    FacetLobes(const WalkSurface& surface, bool from_below)
        : surface_(surface), from_below_(from_below),
          distribution_(kernel_distribution(surface.distribution)) {
        const double other = from_below ? surface.ior_above : surface.ior_below;
        eta_ = surface.is_conductor ? 1.0 : other / surface.own_ior(from_below);
    }

    Vec3 sample(const Vec3& v, WalkRandom& random) const {
        const double u1 = random.next(), u2 = random.next();
        return kernels::microfacet_sample(distribution_, surface_.alpha, v, u1, u2);
    }
    double reflectance(const Vec3& v, const Vec3& h) const {
        return surface_.reflectance(from_below_, std::clamp(kernels::vec3_dot(v, h), 0.0, 1.0));
    }
    static Vec3 reflected(const Vec3& v, const Vec3& h) {
        return kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * kernels::vec3_dot(v, h)), v);
    }
    /// Returns the refracted direction in the frame of the other side.
    Vec3 refracted(const Vec3& v, const Vec3& h) const {
        const double c = kernels::vec3_dot(v, h);
        return kernels::vec3_sub(
            kernels::vec3_scale(v, 1.0 / eta_),
            kernels::vec3_scale(h, c / eta_ - kernels::fresnel_cos_transmitted(c, eta_)));
    }

    /// Flux density, 1/sr, of light from v that facets seen by v send towards w, shadowing left
    /// out (Heitz et al. 2016, eqs. 32 and 33); h is the facet's normal, if there is one.
    double density(const Vec3& v, const SurfaceTarget& target, Vec3& h) const {
        if (surface_.is_conductor && !target.same_side)
            return 0.0;
        h = target.same_side ? kernels::vec3_add(v, target.w)
                             : kernels::vec3_sub(kernels::vec3_scale(target.w, eta_), v);
        const double length = std::sqrt(kernels::vec3_dot(h, h));
        if (!(length > 0.0))
            return 0.0;
        h = kernels::vec3_scale(h, (h.z > 0.0 ? 1.0 : -1.0) / length);
        const double cos_v = kernels::vec3_dot(v, h), cos_w = kernels::vec3_dot(target.w, h);
        const double area = visible_area(v);
        if (!(cos_v > 0.0) || !(cos_w > 0.0) || !(area > 0.0))
            return 0.0;
        const double d = kernels::microfacet_d(distribution_, surface_.alpha, h) / area;
        const double r = reflectance(v, h);
        if (target.same_side)
            return 0.25 * d * r;
        const double denominator = eta_ * cos_w - cos_v; // with sign, squared
        return (1.0 - r) * d * cos_v * eta_ * eta_ * cos_w / (denominator * denominator);
    }

    /// Share of a facet's light towards w that single scattering lets out, over what the facets'
    /// visible area from v accounts for.
    double visible(const Vec3& v, const Vec3& w, const Vec3& h) const {
        if (is_blinn()) {
            return std::min({1.0, 2.0 * h.z * w.z / std::max(kernels::vec3_dot(w, h), 1e-300),
                             2.0 * h.z * v.z / kernels::vec3_dot(v, h)});
        }
        const double lambda_v = microsurface::lambda(distribution_, surface_.alpha, v);
        return (1.0 + lambda_v) /
               (1.0 + lambda_v + microsurface::lambda(distribution_, surface_.alpha, w));
    }
    bool is_blinn() const { return surface_.distribution == Distribution::Blinn; }

private:
    /// Projected area of the facets that v sees; V-cavities are not sampled by it.
    double visible_area(const Vec3& v) const {
        return is_blinn() ? v.z
                          : v.z + kernels::microfacet_lambda_cos(distribution_, surface_.alpha, v);
    }

    const WalkSurface& surface_;
    bool from_below_;
    int distribution_;
    double eta_;
};

/// A facet's two branches: the one chosen and the weight of conductors, which have only one.
struct Branch {
    bool reflects;
    double weight;
};
Branch choose_branch(const WalkSurface& surface, double reflectance, WalkRandom& random) {
    if (surface.is_conductor)
        return {true, reflectance};
    return {random.next() < reflectance, 1.0};
}

void add_single_values(const FacetLobes& lobes, const Vec3& v, std::span<SurfaceTarget> targets) {
    for (SurfaceTarget& target : targets) {
        Vec3 h{};
        const double density = lobes.density(v, target, h);
        if (density > 0.0)
            target.value += density * lobes.visible(v, target.w, h) / target.w.z;
    }
}

/// One scattering by Smith's facets, sampled as they are seen.
SurfaceEvent scatter_once(const WalkSurface& surface, const FacetLobes& lobes, const Vec3& v,
                          WalkRandom& random) {
    const Vec3 h = lobes.sample(v, random);
    if (!(kernels::vec3_dot(v, h) > 0.0))
        return {true, v, 0.0, 1.0};
    const Branch branch = choose_branch(surface, lobes.reflectance(v, h), random);
    SurfaceEvent event;
    event.same_side = branch.reflects;
    event.w = branch.reflects ? lobes.reflected(v, h) : lobes.refracted(v, h);
    const double kept = event.w.z > 0.0 ? lobes.visible(v, event.w, h) : 0.0;
    event.weight = branch.weight * kept;
    event.lost = branch.weight * (1.0 - kept);
    return event;
}

/// One scattering by V-cavities. Their facets are sampled by D alone, with weights between 0 and
/// 2 whose product would grow without bound in a white stack; one of 16 facets and their branches,
/// drawn by its weight, has a weight near 1 (resampled importance sampling, Talbot et al. 2005).
SurfaceEvent scatter_in_cavity(const WalkSurface& surface, const FacetLobes& lobes, const Vec3& v,
                               WalkRandom& random) {
    constexpr int facets = 16;
    SurfaceEvent event;
    double arrives = 0.0;
    const auto offer = [&](bool reflects, const Vec3& w, double share, double kept) {
        arrives += share / facets;
        if (!(w.z > 0.0) || !(share * kept > 0.0))
            return;
        event.weight += share * kept / facets;
        if (random.next() * event.weight < share * kept / facets) {
            event.same_side = reflects;
            event.w = w;
        }
    };
    for (int k = 0; k < facets; ++k) {
        const Vec3 h = lobes.sample(v, random);
        const double cos_v = kernels::vec3_dot(v, h);
        if (!(cos_v > 0.0))
            continue;
        const double r = lobes.reflectance(v, h), sampled = cos_v / (v.z * h.z);
        const Vec3 reflected = lobes.reflected(v, h);
        offer(true, reflected, r, sampled * lobes.visible(v, reflected, h));
        if (!surface.is_conductor) {
            const Vec3 refracted = lobes.refracted(v, h);
            offer(false, refracted, 1.0 - r, sampled * lobes.visible(v, refracted, h));
        }
    }
    event.lost = (surface.is_conductor ? arrives : 1.0) - event.weight;
    return event;
}

/// Single scattering of V-cavities, and what it loses given back.
SurfaceEvent scatter_and_give_back(const WalkSurface& surface, bool from_below,
                                   const FacetLobes& lobes, const Vec3& v,
                                   std::span<SurfaceTarget> targets, WalkRandom& random) {
    const bool thin_above = surface.is_conductor || surface.ior_above <= surface.ior_below;
    const auto side_of = [&](bool below) {
        return surface.is_conductor ? 0 : static_cast<int>(below == thin_above);
    };
    const LostFlux& flux = *surface.lost;
    const int own = side_of(from_below);
    const double lost = flux.lost(own, v.z);
    for (SurfaceTarget& target : targets) {
        if (target.same_side || !surface.is_conductor) {
            const int side = side_of(target.same_side ? from_below : !from_below);
            target.value += surface.lost_reflectance * flux.value(own, v.z, side, target.w.z);
        }
    }
    add_single_values(lobes, v, targets);
    if (random.next() >= lost) {
        SurfaceEvent event = scatter_in_cavity(surface, lobes, v, random);
        event.weight /= 1.0 - lost;
        event.lost = 0.0;
        return event;
    }
    const double u1 = random.next(), u2 = random.next();
    const LostFlux::Departure departure = flux.sample(u1, u2);
    const double phi = 2.0 * std::numbers::pi * random.next();
    const double s = std::sqrt((1.0 - departure.cosine) * (1.0 + departure.cosine));
    return {departure.side == own,
            kernels::vec3(s * std::cos(phi), s * std::sin(phi), departure.cosine),
            surface.lost_reflectance, 0.0};
}

/// Walk on the Smith microsurface of one surface.
SurfaceEvent walk_between_facets(const WalkSurface& surface, bool from_below, Vec3 v,
                                 std::span<SurfaceTarget> targets, WalkRandom& random) {
    const int distribution = kernel_distribution(surface.distribution);
    const auto escape = [&](const Vec3& w, double height) {
        return microsurface::escape(distribution, surface.alpha, w, height);
    };
    SurfaceEvent event{true, v, 1.0, 0.0}; // same_side, weight: of the walk so far
    double height = microsurface::next_height(distribution, surface.alpha, microsurface::negated(v),
                                              1.0, random.next());
    // most walks end after one or two facets; light trapped for 1000 is not worth following
    for (int order = 1; order <= 1000; ++order) {
        const FacetLobes lobes(surface, event.same_side == from_below);
        for (SurfaceTarget& target : targets) {
            const bool stays = target.same_side == event.same_side;
            Vec3 h{};
            const double density = lobes.density(v, {stays, target.w}, h);
            if (density > 0.0) {
                target.value += event.weight * density *
                                escape(target.w, stays ? height : 1.0 - height) / target.w.z;
            }
        }
        const Vec3 h = lobes.sample(v, random);
        const Branch branch = choose_branch(surface, lobes.reflectance(v, h), random);
        event.weight *= branch.weight;
        event.w = branch.reflects ? lobes.reflected(v, h) : lobes.refracted(v, h);
        if (!branch.reflects) {
            event.same_side = !event.same_side;
            height = 1.0 - height;
        }
        if (random.next() < escape(event.w, height))
            return event;
        height =
            microsurface::next_height(distribution, surface.alpha, event.w, height, random.next());
        v = microsurface::negated(event.w);
    }
    event.weight = 0.0;
    return event;
}

/// Kulla and Conty 2017: what stays of light that bounces between the facets of a metal, whose
/// single scattering keeps the share `kept` on average.
double bounced_reflectance(const WalkSurface& surface) {
    const double mean = integrate_sin2(
        0.0, 1.0, 32, [&](double c) { return 2.0 * c * surface.reflectance(false, c); });
    const double lost =
        integrate_sin2(0.0, 1.0, 64, [&](double c) { return 2.0 * c * surface.lost->lost(0, c); });
    const double kept = 1.0 - lost;
    return mean * mean * kept / (1.0 - mean * lost);
}

} // namespace

double WalkSurface::reflectance(bool from_below, double cos_i) const {
    const double own = own_ior(from_below);
    const double other = is_conductor || !from_below ? ior_below : ior_above;
    return kernels::thin_film_reflectance(cos_i, own, film.ior, other, kappa, film.thickness_nm,
                                          wavelength_nm);
}

WalkSurface walk_surface(const SurfaceValues& values) {
    WalkSurface surface{values};
    if (!values.scatters())
        surface.alpha = 0.0;
    if (!surface.is_rough() || surface.distribution != Distribution::Blinn ||
        surface.scattering != Scattering::Multiple)
        return surface;
    if (surface.is_conductor) {
        surface.lost = LostFlux::of(0.0, surface.alpha);
        surface.lost_reflectance = bounced_reflectance(surface);
    } else {
        const double ratio = surface.ior_below / surface.ior_above;
        surface.lost = LostFlux::of(std::max(ratio, 1.0 / ratio), surface.alpha);
    }
    return surface;
}

SurfaceEvent meet_smooth_surface(const WalkSurface& surface, bool from_below, const Vec3& v,
                                 WalkRandom& random) {
    const double reflectance = surface.reflectance(from_below, std::min(v.z, 1.0));
    const Branch branch = choose_branch(surface, reflectance, random);
    return {branch.reflects,
            branch.reflects ? kernels::vec3(-v.x, -v.y, v.z)
                            : refract_at_smooth_surface(surface, from_below, v),
            branch.weight, 0.0};
}

Vec3 refract_at_smooth_surface(const WalkSurface& surface, bool from_below, const Vec3& v) {
    return FacetLobes(surface, from_below).refracted(v, kernels::vec3(0.0, 0.0, 1.0));
}

SurfaceEvent meet_rough_surface(const WalkSurface& surface, bool from_below, const Vec3& v,
                                std::span<SurfaceTarget> targets, WalkRandom& random) {
    if (surface.distribution != Distribution::Blinn && surface.scattering == Scattering::Multiple)
        return walk_between_facets(surface, from_below, v, targets, random);
    const FacetLobes lobes(surface, from_below);
    if (surface.scattering == Scattering::Multiple)
        return scatter_and_give_back(surface, from_below, lobes, v, targets, random);
    add_single_values(lobes, v, targets);
    return lobes.is_blinn() ? scatter_in_cavity(surface, lobes, v, random)
                            : scatter_once(surface, lobes, v, random);
}

} // namespace reradiant
